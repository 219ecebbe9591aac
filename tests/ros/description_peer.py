#!/usr/bin/env python3
"""Loads urdf/baxter.urdf with ROS' own programs, and stands in for what `valet doctor` must name before a trial.

robot_state_publisher must put both grippers where another library's vectors have them, without a complaint.
"""
import json
import math
import os
import subprocess
import tempfile
import time
import unittest

import rospy
import rostest
from sensor_msgs.msg import JointState
from std_msgs.msg import Empty, Float64, String
from tf2_msgs.msg import TFMessage

HERE = os.path.dirname(os.path.realpath(__file__))
ROOT = os.path.join(HERE, "..", "..")
STATE_PUBLISHER = "/usr/lib/robot_state_publisher/robot_state_publisher"
JOINTS = ("s0", "s1", "e0", "e1", "w0", "w1", "w2")


def turned(q, v):
    """A vector turned by a quaternion x y z w."""
    x, y, z, w = q
    t = [2 * (y * v[2] - z * v[1]), 2 * (z * v[0] - x * v[2]), 2 * (x * v[1] - y * v[0])]
    return [v[0] + w * t[0] + y * t[2] - z * t[1], v[1] + w * t[1] + z * t[0] - x * t[2], v[2] + w * t[2] + x * t[1] - y * t[0]]


class Description(unittest.TestCase):
    """The description, and the arms' lines of the list before a trial."""

    @classmethod
    def setUpClass(cls):
        rospy.init_node("peer")
        with open(os.path.join(ROOT, "urdf", "baxter.urdf")) as file:
            cls.text = file.read()

    def doctor(self):
        program = os.path.join(ROOT, "target", "debug", "valet")
        done = subprocess.run([program, "doctor", "--seconds", "3", "--json"], stdout=subprocess.PIPE)
        lines = [json.loads(line) for line in done.stdout.decode().splitlines()]
        return {line["name"]: line for line in lines if "name" in line}

    def described(self, text):
        rospy.set_param("/robot_description", text)
        try:
            return self.doctor()["robot description"]
        finally:
            rospy.set_param("/robot_description", self.text)

    def test_1_the_state_publisher_puts_the_grippers_where_another_library_has_them(self):
        self.assertIn("Successfully Parsed", subprocess.check_output(
            ["check_urdf", os.path.join(ROOT, "urdf", "baxter.urdf")], stderr=subprocess.STDOUT).decode())
        with open(os.path.join(ROOT, "tests", "vectors", "kinematics", "forward.json")) as file:
            arms = json.load(file)["arms"]
        heard = {}

        def hear(message):
            if message._connection_header["callerid"] == "/described":
                heard.update((step.child_frame_id, step) for step in message.transforms)

        listeners = [rospy.Subscriber(topic, TFMessage, hear) for topic in ("/tf", "/tf_static")]
        states = rospy.Publisher("/vectors", JointState, queue_size=2)
        said = tempfile.TemporaryFile()
        publisher = subprocess.Popen(
            [STATE_PUBLISHER, "joint_states:=/vectors", "__name:=described"], stdout=said, stderr=subprocess.STDOUT)
        try:
            for index in (0, 1, 50, 99):
                self.follow(states, heard, {side: arms[side][index] for side in arms})
        finally:
            publisher.terminate()
            publisher.wait()
            for listener in listeners:
                listener.unregister()
        said.seek(0)
        words = said.read().decode()
        self.assertNotRegex(words.lower(), "warn|error", "it loads without a complaint")

    def follow(self, states, heard, cases):
        names = [side + "_" + joint for side in cases for joint in JOINTS]
        positions = [value for side in cases for value in cases[side]["joints"]]
        ends, errors = time.time() + 40, None
        while time.time() < ends:
            state = JointState(name=names, position=positions)
            state.header.stamp = rospy.Time.now()
            states.publish(state)
            rospy.sleep(0.05)
            errors = [self.error(heard, side + "_gripper", case["position"]) for side, case in cases.items()]
            if max(errors) < 1e-6:
                return
        self.fail("the grippers are %s m from where they should be" % errors)

    @staticmethod
    def error(heard, frame, place):
        point = [0.0, 0.0, 0.0]
        while frame != "base":
            if frame not in heard:
                return math.inf
            step = heard[frame]
            move, turn = step.transform.translation, step.transform.rotation
            point = turned((turn.x, turn.y, turn.z, turn.w), point)
            point = [a + b for a, b in zip(point, (move.x, move.y, move.z))]
            frame = step.header.frame_id
        return math.dist(point, place)

    def test_2_nothing_to_say_of_a_robot_as_valet_knows_it(self):
        found = self.doctor()
        for name in ("robot description", "left joints", "right joints", "trajectory servers", "speed ratio",
                     "suppressed safety behaviours", "/robot/joint_states"):
            self.assertEqual(found[name]["verdict"], "good", found[name])

    def test_3_another_limit_is_shown_with_both_values(self):
        limit = 'lower="-0.05" upper="2.618"'
        self.assertIn(limit, self.text)
        found = self.described(self.text.replace(limit, 'lower="-0.05" upper="2.4"'))
        self.assertEqual(found["verdict"], "late", found)
        for word in ("left_e1", "right_e1", "2.6180", "2.4000"):
            self.assertIn(word, found["value"], found)

    def test_4_a_description_that_lacks_a_joint_is_a_fault_by_its_name(self):
        found = self.described(self.text.replace('name="left_w1"', 'name="left_w7"'))
        self.assertEqual(found["verdict"], "fault", found)
        self.assertIn("left_w", found["value"], found)

    def test_5_who_would_fight_for_the_arms_is_named_with_the_topic(self):
        limb = "/robot/limb/left/"
        told = [
            ("trajectory servers", "fault", limb + "follow_joint_trajectory/status", String),
            ("speed ratio", "late", limb + "set_speed_ratio", Float64),
            ("suppressed safety behaviours", "late", limb + "suppress_collision_avoidance", Empty),
            ("other nodes that command the robot", "late", "/robot/set_super_reset", Empty),
        ]
        peers = [rospy.Publisher(topic, kind, queue_size=1) for _, _, topic, kind in told]
        try:
            found = self.doctor()
        finally:
            for peer in peers:
                peer.unregister()
        for name, verdict, topic, _ in told:
            self.assertEqual(found[name]["verdict"], verdict, found[name])
            self.assertIn(rospy.get_name() + " on " + topic, found[name]["value"], found[name])


if __name__ == "__main__":
    rostest.rosrun("valet", "description", Description)
