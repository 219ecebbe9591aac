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
        self.steps, self.names, link = [], [], tip
        while link in above:
            joint = above[link]
            origin = joint.find("origin")
            numbers = [[float(v) for v in (origin.get(k) if origin is not None else "0 0 0").split()] for k in ("xyz", "rpy")]
            moving = joint.get("type") == "revolute"
            self.steps.insert(0, (transform(*numbers), moving))
            if moving:
                self.names.insert(0, joint.get("name"))
            link = joint.find("parent").get("link")

    def tip(self, joints):
        pose, values = transform([0, 0, 0], [0, 0, 0]), iter(joints)
        for fixed, moving in self.steps:
            pose = times(pose, fixed)
            if moving:
                pose = times(pose, transform([0, 0, 0], [0, 0, next(values)]))
        return pose

    def follow(self, joints, place):
        """Joints that bring the tip to a place, at the orientation that it has."""
        wanted = self.tip(joints)
        for row in range(3):
            wanted[row][3] = place[row]
        joints = list(joints)
        for _ in range(30):
            here = self.tip(joints)
            error = twist(here, wanted)
            if max(abs(value) for value in error) < 1e-7:
                return joints
            columns = []
            for index in range(7):
                moved = list(joints)
                moved[index] += 1e-6
                columns.append([value / 1e-6 for value in twist(here, self.tip(moved))])
            gram = [[sum(c[i] * c[j] for c in columns) + (1e-8 if i == j else 0.0) for j in range(6)] for i in range(6)]
            solved = solve(gram, error)
            joints = [q + sum(c[i] * solved[i] for i in range(6)) for q, c in zip(joints, columns)]
        raise ValueError("no joints for this place")


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


class MoveGroup(unittest.TestCase):
    """What valet makes of each kind of move_group."""

    @classmethod
    def setUpClass(cls):
        rospy.init_node("move_group")
        cls.asked = []

    def serve(self, source, fraction=1.0, code=1):
        kind = service_class(source)
        self.assertEqual(kind._md5sum, MD5[source], "the definition is MoveIt's own")
        response = kind._response_class
        self.asked[:] = []

        def plan(request):
            self.asked.append(request)
            arm = Arm(request.link_name)
            joints = dict(zip(request.start_state.joint_state.name, request.start_state.joint_state.position))
            here = [joints[name] for name in arm.names]
            start = [arm.tip(here)[row][3] for row in range(3)]
            end = request.waypoints[0].position
            end = [end.x, end.y, end.z]
            count = max(2, int(math.dist(start, end) / request.max_step) + 1)
            answer = response()
            answer.solution.joint_trajectory.joint_names = arm.names
            module = type(answer.solution.joint_trajectory).__module__
            point = sys.modules[module.replace("_JointTrajectory", "_JointTrajectoryPoint")].JointTrajectoryPoint
            for index in range(count + 1):
                place = [a + (b - a) * index / count for a, b in zip(start, end)]
                here = arm.follow(here, place) if index else here
                answer.solution.joint_trajectory.points.append(point(positions=here))
            answer.fraction, answer.error_code.val = fraction, code
            return answer

        return rospy.Service("/compute_cartesian_path", kind, plan)

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


if __name__ == "__main__":
    rostest.rosrun("valet", "moveit", MoveGroup)
