#!/usr/bin/env python3
"""Stands in for MoveIt's move_group: answers /compute_cartesian_path with the definitions of Noetic and of Melodic.

`valet doctor --planner moveit` asks it for a short line of each arm. It plans with a small inverse kinematics of its own.
"""
import json
import math
import os
import shutil
import subprocess
import sys
import tempfile
import unittest
import xml.etree.ElementTree as ElementTree

import peer

HERE = os.path.dirname(os.path.realpath(__file__))
ROOT = os.path.join(HERE, "..", "..")


def make_messages(source):
    """Writes the Python classes of one definition of moveit_msgs under its real name; Debian has none of these packages."""
    folder = tempfile.mkdtemp(prefix="valet_messages_")
    definitions = os.path.join(folder, "definitions")
    packages = {"moveit_msgs": source, "shape_msgs": "shape_msgs", "object_recognition_msgs": "object_recognition_msgs"}
    packages.update((name, name) for name in ("sensor_msgs", "trajectory_msgs", "geometry_msgs"))
    includes = ["-Istd_msgs:/usr/share/std_msgs/msg"]
    for package, kept in packages.items():
        shutil.copytree(os.path.join(ROOT, "msg", kept), os.path.join(definitions, package))
        includes += ["-I%s:%s" % (package, os.path.join(definitions, package, "msg"))]
    for package in packages:
        for kind, generator in (("msg", "genmsg_py.py"), ("srv", "gensrv_py.py")):
            place = os.path.join(definitions, package, kind)
            if not os.path.isdir(place):
                continue
            out = os.path.join(folder, package, kind)
            os.makedirs(out)
            files = [os.path.join(place, name) for name in sorted(os.listdir(place))]
            program = os.path.join("/usr/lib/genpy", generator)
            subprocess.check_call([program, "-p", package, "-o", out] + includes + files)
            subprocess.check_call(["/usr/lib/genpy/genmsg_py.py", "--initpy", "-p", package, "-o", out])
        open(os.path.join(folder, package, "__init__.py"), "w").close()
    return folder


def service_class(source):
    """The service of one definition, with the modules of the other one forgotten."""
    folder = make_messages(source)
    for name in [name for name in sys.modules if name.split(".")[0] in os.listdir(folder)]:
        del sys.modules[name]
    sys.path.insert(0, folder)
    from moveit_msgs.srv import GetCartesianPath

    sys.path.remove(folder)
    return GetCartesianPath


def times(one, other):
    return [[sum(one[i][k] * other[k][j] for k in range(4)) for j in range(4)] for i in range(4)]


def transform(xyz, rpy):
    (cr, cp, cy), (sr, sp, sy) = [math.cos(a) for a in rpy], [math.sin(a) for a in rpy]
    return [
        [cy * cp, cy * sp * sr - sy * cr, cy * sp * cr + sy * sr, xyz[0]],
        [sy * cp, sy * sp * sr + cy * cr, sy * sp * cr - cy * sr, xyz[1]],
        [-sp, cp * sr, cp * cr, xyz[2]],
        [0.0, 0.0, 0.0, 1.0],
    ]


class Arm:
    """A chain of the robot's description; every joint turns about its own z axis."""

    def __init__(self, tip):
        robot = ElementTree.parse(os.path.join(ROOT, "urdf", "baxter.urdf")).getroot()
        above = {joint.find("child").get("link"): joint for joint in robot.findall("joint")}
        self.steps, self.names, self.ranges, link = [], [], [], tip
        while link in above:
            joint = above[link]
            origin = joint.find("origin")
            numbers = [[float(v) for v in (origin.get(k) if origin is not None else "0 0 0").split()] for k in ("xyz", "rpy")]
            moving = joint.get("type") == "revolute"
            self.steps.insert(0, (transform(*numbers), moving))
            if moving:
                self.names.insert(0, joint.get("name"))
                limit = joint.find("limit")
                self.ranges.insert(0, (float(limit.get("lower")), float(limit.get("upper"))))
            link = joint.find("parent").get("link")

    def tip(self, joints):
        return self.tip_and_axes(joints)[0]

    def tip_and_axes(self, joints):
        """The tip's pose, and each joint's axis and place."""
        pose, values, axes = transform([0, 0, 0], [0, 0, 0]), iter(joints), []
        for fixed, moving in self.steps:
            pose = times(pose, fixed)
            if moving:
                axes.append(([pose[row][2] for row in range(3)], [pose[row][3] for row in range(3)]))
                pose = times(pose, transform([0, 0, 0], [0, 0, next(values)]))
        return pose, axes

    def follow(self, joints, wanted):
        """Joints near the given ones, within their ranges, that bring the tip to a pose; the elbow turns away from the ranges' ends."""
        joints = list(joints)
        for round_ in range(60):
            here, axes = self.tip_and_axes(joints)
            error = twist(here, wanted)
            if max(abs(value) for value in error) < 1e-7:
                return joints
            end = [here[row][3] for row in range(3)]
            columns = [cross(axis, [a - b for a, b in zip(end, place)]) + axis for axis, place in axes]
            gram = [[sum(c[i] * c[j] for c in columns) + (1e-8 if i == j else 0.0) for j in range(6)] for i in range(6)]
            share = 0.0 if round_ else 0.02
            inwards = [share * ((lower + upper) / 2 - q) for q, (lower, upper) in zip(joints, self.ranges)]
            moved = [sum(c[i] * step for c, step in zip(columns, inwards)) for i in range(6)]
            solved = solve(gram, [e - m for e, m in zip(error, moved)])
            steps = [step + sum(c[i] * solved[i] for i in range(6)) for step, c in zip(inwards, columns)]
            joints = [q + step for q, step in zip(joints, steps)]
            joints = [min(max(q, lower), upper) for q, (lower, upper) in zip(joints, self.ranges)]
        raise ValueError("no joints for this place")


def cross(a, b):
    return [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]


def posed(message):
    """A pose message as a matrix."""
    p, q = message.position, message.orientation
    x, y, z, w = q.x, q.y, q.z, q.w
    return [
        [1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w), p.x],
        [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w), p.y],
        [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y), p.z],
        [0.0, 0.0, 0.0, 1.0],
    ]


def between(start, end, share):
    """A share of the way in a straight line with an even turn about one axis."""
    turn = [[sum(end[i][k] * start[j][k] for k in range(3)) for j in range(3)] for i in range(3)]
    axis = [turn[2][1] - turn[1][2], turn[0][2] - turn[2][0], turn[1][0] - turn[0][1]]
    sine, cosine = math.hypot(*axis) / 2, (turn[0][0] + turn[1][1] + turn[2][2] - 1) / 2
    angle = math.atan2(sine, cosine) * share
    pose = [list(row) for row in start]
    if sine > 1e-9:
        x, y, z = (value / (2 * sine) for value in axis)
        c, s = math.cos(angle), math.sin(angle)
        v = 1 - c
        part = [
            [c + x * x * v, x * y * v - z * s, x * z * v + y * s, 0.0],
            [y * x * v + z * s, c + y * y * v, y * z * v - x * s, 0.0],
            [z * x * v - y * s, z * y * v + x * s, c + z * z * v, 0.0],
            [0.0, 0.0, 0.0, 1.0],
        ]
        pose = times(part, start)
    for row in range(3):
        pose[row][3] = start[row][3] + (end[row][3] - start[row][3]) * share
    return pose


def twist(here, there):
    """Small motion from one frame to another: metres, then radians."""
    turn = [[sum(there[i][k] * here[j][k] for k in range(3)) for j in range(3)] for i in range(3)]
    angles = [(turn[2][1] - turn[1][2]) / 2, (turn[0][2] - turn[2][0]) / 2, (turn[1][0] - turn[0][1]) / 2]
    return [there[i][3] - here[i][3] for i in range(3)] + angles


def solve(matrix, side):
    rows = [row + [value] for row, value in zip(matrix, side)]
    for column in range(6):
        pivot = max(range(column, 6), key=lambda row: abs(rows[row][column]))
        rows[column], rows[pivot] = rows[pivot], rows[column]
        for row in range(6):
            if row != column:
                factor = rows[row][column] / rows[column][column]
                rows[row] = [a - factor * b for a, b in zip(rows[row], rows[column])]
    return [rows[row][6] / rows[row][row] for row in range(6)]


sys.path.insert(0, make_messages("moveit_msgs"))

import rospy  # noqa: E402
import rostest  # noqa: E402

MD5 = {"moveit_msgs": "c54b9430d97ea6816e0f7c7ffd3779b8", "moveit_msgs_melodic": "5c9a54219f0d91a804e7670bc0e118f1"}


# Ways of one trial that must have been driven to their ends: two arms, each with several goals.
LINES = 6
# Seconds that a trial may take on a busy computer; it takes some 100 on an idle one.
TRIAL = 400.0


class MoveGroup(unittest.TestCase):
    """What valet makes of each kind of move_group."""

    @classmethod
    def setUpClass(cls):
        rospy.init_node("move_group")
        cls.asked, cls.ends, cls.driven = [], {}, 0

    def setUp(self):
        """A robot and a person of its own for each test: a trial leaves the garment where it ended."""
        self.robot = peer.Valet("sim", "--seed", "5")

    def tearDown(self):
        self.robot.end()

    def serve(self, source, fraction=1.0, code=1):
        kind = service_class(source)
        self.assertEqual(kind._md5sum, MD5[source], "the definition is MoveIt's own")
        response = kind._response_class
        self.asked[:] = []
        self.ends.clear()
        MoveGroup.driven = 0

        def plan(request):
            self.asked.append(request)
            arm = Arm(request.link_name)
            joints = dict(zip(request.start_state.joint_state.name, request.start_state.joint_state.position))
            here = [joints[name] for name in arm.names]
            self.note_driven(request.link_name, here)
            begun = here
            start, end = arm.tip(here), posed(request.waypoints[0])
            length = math.dist(*([pose[row][3] for row in range(3)] for pose in (start, end)))
            count = max(2, int(length / request.max_step) + 1)
            answer = response()
            answer.solution.joint_trajectory.joint_names = arm.names
            module = type(answer.solution.joint_trajectory).__module__
            point = sys.modules[module.replace("_JointTrajectory", "_JointTrajectoryPoint")].JointTrajectoryPoint
            points, reached = answer.solution.joint_trajectory.points, fraction
            for index in range(count + 1):
                try:
                    here = arm.follow(here, between(start, end, index / count)) if index else here
                except ValueError:
                    reached = (index - 1) / count
                    break
                points.append(point(positions=here))
            if max(abs(a - b) for a, b in zip(begun, here)) > 0.05:
                self.ends[request.link_name] = here
            answer.fraction, answer.error_code.val = reached, code
            return answer

        return rospy.Service("/compute_cartesian_path", kind, plan)

    def note_driven(self, link, here):
        """Counts a way that the arm has been driven along: the next one is asked for from its very end."""
        end = self.ends.pop(link, None)
        if end and max(abs(a - b) for a, b in zip(end, here)) < 0.01:
            MoveGroup.driven += 1

    def doctor(self):
        program = os.path.join(ROOT, "target", "debug", "valet")
        done = subprocess.run([program, "doctor", "--planner", "moveit", "--seconds", "2", "--json"], stdout=subprocess.PIPE)
        lines = [json.loads(line) for line in done.stdout.decode().splitlines()]
        found = [line for line in lines if line.get("name") == "planner"]
        self.assertEqual(len(found), 1, lines)
        return found[0]

    def judged(self, source, verdict, words, **kind):
        service = self.serve(source, **kind)
        try:
            check = self.doctor()
        finally:
            service.shutdown()
        self.assertEqual(check["verdict"], verdict, check)
        self.assertIn(words, check["value"], check)

    def test_1_noetic(self):
        self.judged("moveit_msgs", "good", "both arms")
        self.assertEqual(sorted(request.group_name for request in self.asked), ["left_arm", "right_arm"])
        for request in self.asked:
            self.assertTrue(request.avoid_collisions)
            self.assertEqual(request.header.frame_id, "base")
            self.assertEqual(len(request.start_state.joint_state.name), 14)

    def test_2_melodic_and_older(self):
        self.judged("moveit_msgs_melodic", "good", "both arms")

    def test_3_a_part_of_the_line_is_refused(self):
        self.judged("moveit_msgs", "fault", "only 43 %", fraction=0.43)

    def test_4_a_refusal_is_told_in_words(self):
        self.judged("moveit_msgs_melodic", "fault", "no inverse kinematics", code=-31)

    def test_5_nobody_answers(self):
        check = self.doctor()
        self.assertEqual(check["verdict"], "fault", check)
        self.assertIn("/compute_cartesian_path", check["value"])

    def test_6_a_trial_along_noetics_ways(self):
        self.whole_trial("moveit_msgs")

    def test_7_a_trial_along_the_ways_of_melodic_and_older(self):
        self.whole_trial("moveit_msgs_melodic")

    def whole_trial(self, source):
        """A trial in the simulated robot's world, from Enable to both arms dressed: each straight line is asked for, and driven."""
        service = self.serve(source)
        valet = peer.Valet("console", "--headless", "--no-record", "--planner", "moveit")
        try:
            valet.await_line("the ROS master answers")
            valet.until_accepted("enable", "enable the robot")
            valet.until_accepted("start", "start the trial")
            self.assertIn("completed: both arms are dressed", valet.until_ended(TRIAL))
            said = "\n".join(valet.lines)
            valet.type("quit")
            self.assertEqual(valet.process.wait(peer.PATIENCE), 0, said)
            self.assertGreaterEqual(self.driven, LINES, said)
        finally:
            valet.end()
            service.shutdown()


if __name__ == "__main__":
    rostest.rosrun("valet", "moveit", MoveGroup)
