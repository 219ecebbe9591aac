#!/usr/bin/env python3
"""A rospy peer that drives the simulated Baxter: it moves only when enabled, and stops when told."""
import threading
import unittest

import peer

peer.make_messages()

import rospy  # noqa: E402
import rostest  # noqa: E402
from baxter_core_msgs.msg import AssemblyState, EndpointState, JointCommand  # noqa: E402
from sensor_msgs.msg import JointState  # noqa: E402
from std_msgs.msg import Bool, Empty, Float64  # noqa: E402

JOINTS = ["left_" + joint for joint in ("s0", "s1", "e0", "e1", "w0", "w1", "w2")]


class SimulatedRobot(unittest.TestCase):
    """The robot's own rules, seen from outside."""

    @classmethod
    def setUpClass(cls):
        rospy.init_node("simulated_robot_peer")
        cls.changed = threading.Condition()
        cls.state, cls.joints, cls.fingers, cls.endpoints = None, None, 0, 0
        rospy.Subscriber("/robot/state", AssemblyState, cls.take_state, queue_size=1)
        rospy.Subscriber("/robot/joint_states", JointState, cls.take_joints, queue_size=8)
        rospy.Subscriber("/robot/limb/left/endpoint_state", EndpointState, cls.take_endpoint, queue_size=8)
        cls.stop = rospy.Publisher("/robot/set_super_stop", Empty, queue_size=1)
        cls.reset = rospy.Publisher("/robot/set_super_reset", Empty, queue_size=1)
        cls.enable = rospy.Publisher("/robot/set_super_enable", Bool, queue_size=1)
        cls.command = rospy.Publisher("/robot/limb/left/joint_command", JointCommand, queue_size=1)
        cls.timeout = rospy.Publisher("/robot/limb/left/joint_command_timeout", Float64, queue_size=1, latch=True)

    @classmethod
    def take_state(cls, message):
        with cls.changed:
            cls.state = message
            cls.changed.notify_all()

    @classmethod
    def take_joints(cls, message):
        with cls.changed:
            if len(message.name) == 1:
                cls.fingers += 1
            else:
                cls.joints = message
            cls.changed.notify_all()

    @classmethod
    def take_endpoint(cls, _message):
        with cls.changed:
            cls.endpoints += 1
            cls.changed.notify_all()

    def until(self, what, condition, act=None):
        """Waits for a condition, repeating an act as the robot's own tools do; gives up after 15 s."""
        end = rospy.get_time() + 15.0
        while rospy.get_time() < end:
            if act:
                act()
            with self.changed:
                if condition():
                    return
                self.changed.wait(0.02)
        self.fail("not within 15 s: " + what)

    def positions(self):
        named = dict(zip(self.joints.name, self.joints.position))
        return [named[joint] for joint in JOINTS]

    def ask(self, goal):
        self.command.publish(JointCommand(mode=JointCommand.POSITION_MODE, command=goal, names=JOINTS))

    def test_1_topics_come_as_from_the_real_robot(self):
        self.until("joints, fingers and end points", lambda: self.joints and self.fingers > 5 and self.endpoints > 50)
        self.assertEqual(self.joints.name, sorted(self.joints.name))
        self.assertEqual(len(self.joints.name), 17)

    def test_2_disabled_it_does_not_move(self):
        self.until("a state", lambda: self.state is not None and self.joints is not None)
        self.assertFalse(self.state.enabled)
        before = self.positions()
        goal = [position + 0.2 for position in before]
        for _ in range(50):
            self.ask(goal)
            rospy.sleep(0.01)
        self.assertEqual(before, self.positions())

    def test_3_enabled_it_follows(self):
        self.until("enabled", lambda: self.state.enabled, lambda: self.enable.publish(True))
        goal = [position + 0.1 for position in self.positions()]
        self.until(
            "at the goal",
            lambda: max(abs(a - b) for a, b in zip(goal, self.positions())) < 0.02,
            lambda: self.ask(goal),
        )

    def test_4_after_the_last_command_it_holds_within_the_time_out(self):
        before = self.positions()
        # Far enough that the arm is still on its way when the commands end.
        goal = [position - 0.9 * (joint == "left_s0") for joint, position in zip(JOINTS, before)]
        self.until("under way", lambda: before[0] - self.positions()[0] > 0.05, lambda: self.ask(goal))
        # 0.2 s of the robot, and a hundred beats of room for a machine that is busy.
        rospy.sleep(1.2)
        held = self.positions()
        rospy.sleep(1.0)
        self.assertEqual(held, self.positions(), "it holds")
        self.assertGreater(held[0] - goal[0], 0.2, "and has not gone on to the goal")
        self.assertTrue(self.state.enabled)

    def test_5_a_longer_time_out_carries_one_command_to_its_goal(self):
        self.until("a listener", lambda: self.timeout.get_num_connections() > 0)
        self.timeout.publish(30.0)
        rospy.sleep(0.5)
        goal = [position + 0.3 * (joint == "left_s0") for joint, position in zip(JOINTS, self.positions())]
        self.ask(goal)
        self.until("at the goal", lambda: max(abs(a - b) for a, b in zip(goal, self.positions())) < 0.02)
        self.timeout.publish(0.2)

    def test_6_stopped_it_stands_until_reset_and_enable(self):
        self.until("stopped", lambda: self.state.stopped, lambda: self.stop.publish())
        self.assertFalse(self.state.enabled)
        rospy.sleep(0.3)
        before = self.positions()
        goal = [position + 0.2 for position in before]
        for _ in range(30):
            self.ask(goal)
            rospy.sleep(0.01)
        self.assertEqual(before, self.positions())
        self.until("reset", lambda: not self.state.stopped, lambda: self.reset.publish())
        self.assertFalse(self.state.enabled, "a reset leaves the robot disabled")


if __name__ == "__main__":
    rostest.rosrun("valet", "simulated_robot", SimulatedRobot)
