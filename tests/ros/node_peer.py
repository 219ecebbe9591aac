#!/usr/bin/env python3
"""rospy plays the robot for the node: commands come only after Enable and Start, a stop arrives, bad input never moves."""
import math
import threading
import time
import unittest

import peer

peer.make_messages()

import rospy  # noqa: E402
import rostest  # noqa: E402
from baxter_core_msgs.msg import AssemblyState, DigitalIOState, EndpointState, JointCommand  # noqa: E402
from geometry_msgs.msg import TransformStamped  # noqa: E402
from sensor_msgs.msg import Image, JointState  # noqa: E402
from std_msgs.msg import Bool, Empty, Float64  # noqa: E402
from tf2_msgs.msg import TFMessage  # noqa: E402

SIDES = ("left", "right")
NAMES = ("s0", "s1", "e0", "e1", "w0", "w1", "w2")
# The posture after `tuck_arms.py -u`.
UNTUCKED = {"left": [-0.08, -1.0, -1.19, 1.94, 0.67, 1.03, -0.5], "right": [0.08, -1.0, 1.19, 1.94, -0.67, 1.03, 0.5]}
# A seated person in `base`, metres: the simulated one's arms, as a skeleton tracker reports them.
PERSON = {
    "neck_1": (0.84, 0.0, 0.28),
    "left_shoulder_1": (0.84, 0.15, 0.20),
    "left_elbow_1": (0.79, 0.35, -0.03),
    "left_hand_1": (0.76, 0.66, 0.02),
    "right_shoulder_1": (0.84, -0.15, 0.20),
    "right_elbow_1": (0.78, -0.37, -0.02),
    "right_hand_1": (0.74, -0.66, -0.14),
}


class Robot:
    """A robot that follows at once, at 100 Hz; what is spoiled is up to the test."""

    def __init__(self):
        self.lock = threading.Lock()
        self.enabled, self.stopped = False, False
        self.positions = {side: list(UNTUCKED[side]) for side in SIDES}
        self.commands, self.stops, self.told = [], 0, {}
        self.force, self.shift, self.missing, self.reverse, self.squeezed = 0.0, 0.0, None, False, None
        self.state = rospy.Publisher("/robot/state", AssemblyState, queue_size=2)
        self.joints = rospy.Publisher("/robot/joint_states", JointState, queue_size=2)
        self.transforms = rospy.Publisher("/tf", TFMessage, queue_size=2)
        self.cuffs = {
            side: rospy.Publisher("/robot/digital_io/%s_lower_cuff/state" % side, DigitalIOState, queue_size=2)
            for side in SIDES
        }
        self.ends = {
            side: rospy.Publisher("/robot/limb/%s/endpoint_state" % side, EndpointState, queue_size=2) for side in SIDES
        }
        for side in SIDES:
            limb = "/robot/limb/%s/" % side
            rospy.Subscriber(limb + "joint_command", JointCommand, self.follow, side, queue_size=8)
            for word in ("set_speed_ratio", "joint_command_timeout"):
                rospy.Subscriber(limb + word, Float64, self.hear, (side, word))
        rospy.Subscriber("/robot/set_super_stop", Empty, self.stop)
        rospy.Subscriber("/robot/set_super_reset", Empty, self.reset)
        rospy.Subscriber("/robot/set_super_enable", Bool, self.enable)
        threading.Thread(target=self.run, daemon=True).start()

    def hear(self, message, key):
        self.told[key] = message.data

    def follow(self, message, side):
        with self.lock:
            self.commands.append((time.monotonic(), side, message))
            if self.enabled and not self.stopped:
                self.positions[side] = list(message.command)

    def stop(self, _message):
        with self.lock:
            self.stops += 1
            self.enabled, self.stopped = False, True

    def reset(self, _message):
        with self.lock:
            self.stopped = False

    def enable(self, message):
        with self.lock:
            self.enabled = message.data and not self.stopped

    def run(self):
        rate, beat = rospy.Rate(100), 0
        while not rospy.is_shutdown():
            self.publish(beat)
            beat += 1
            rate.sleep()

    def publish(self, beat):
        now = rospy.Time.now()
        stamp = now + rospy.Duration(self.shift)
        with self.lock:
            named = [(side + "_" + name, place) for side in SIDES for name, place in zip(NAMES, self.positions[side])]
            state = AssemblyState(ready=self.enabled, enabled=self.enabled, stopped=self.stopped)
        named = [pair for pair in named if pair[0] != self.missing]
        if self.reverse:
            named.reverse()
        joints = JointState(name=[name for name, _ in named], position=[place for _, place in named])
        joints.header.stamp = stamp
        self.state.publish(state)
        self.joints.publish(joints)
        for side in SIDES:
            end = EndpointState()
            end.header.stamp = stamp
            end.pose.position.x, end.pose.position.y, end.pose.position.z = 0.6, 0.4 if side == "left" else -0.4, 0.3
            end.pose.orientation.w = 1.0
            # A reading that never changes would be a frozen sensor.
            end.wrench.force.x = self.force + 0.1 * math.sin(beat)
            self.ends[side].publish(end)
            self.cuffs[side].publish(DigitalIOState(state=int(self.squeezed == side), isInputOnly=True))
        if beat % 3 == 0:
            self.transforms.publish(TFMessage([self.transform(now, *pair) for pair in PERSON.items()]))

    @staticmethod
    def transform(now, name, place):
        transform = TransformStamped(child_frame_id=name)
        transform.header.stamp, transform.header.frame_id = now, "base"
        translation = transform.transform.translation
        translation.x, translation.y, translation.z = place
        transform.transform.rotation.w = 1.0
        return transform

    def count(self, since=0.0):
        with self.lock:
            return sum(1 for command in self.commands if command[0] >= since)


class NodeUnderTest(unittest.TestCase):
    """The order of the operator's acts, seen from the robot."""

    @classmethod
    def setUpClass(cls):
        rospy.init_node("robot_peer")
        cls.robot = Robot()
        cls.valet = peer.Valet("console", "--headless", "--no-record")
        cls.valet.await_line("the ROS master answers")

    @classmethod
    def tearDownClass(cls):
        cls.valet.end()

    def quiet_for(self, seconds):
        """Nothing may be commanded from now on; a command that was under way already may still arrive."""
        time.sleep(0.3)
        since = time.monotonic()
        time.sleep(seconds)
        self.assertEqual(self.robot.count(since), 0, "the robot was commanded")

    def still_for(self, seconds):
        """The arms are asked for one posture alone: a hold keeps them where they are, once they have braked."""
        time.sleep(1.0)
        since = time.monotonic()
        time.sleep(seconds)
        with self.robot.lock:
            asked = {(side, tuple(message.command)) for at, side, message in self.robot.commands if at >= since}
        self.assertLessEqual(len(asked), 2, "the arms were moved")

    def until(self, what, condition, act=None):
        end = time.monotonic() + peer.PATIENCE
        while time.monotonic() < end:
            if condition():
                return
            if act:
                act()
            time.sleep(0.1)
        self.fail("not in time: %s; the node said:\n%s" % (what, "\n".join(self.valet.lines[-30:])))

    def begin(self):
        """Enable and Start as two acts; between them nothing moves."""
        self.valet.until_accepted("enable", "enable the robot")
        self.until("enabled", lambda: self.robot.enabled)
        self.quiet_for(1.0)
        self.valet.until_accepted("start", "start the trial")
        self.moves()

    def moves(self):
        """The arms are commanded; a hold under load is continued, as an operator does."""
        since = time.monotonic()
        self.until("commands", lambda: self.robot.count(since) > 20, self.go_on)

    def holds_and_says(self, *words):
        """The node says why nothing moves, also to an operator who wants to go on, and nothing moves."""
        since = self.valet.mark()

        def said():
            lines = self.valet.lines[since:]
            return any(word in line for line in lines for word in words)

        self.until("one of %s" % (words,), said, self.go_on)
        self.still_for(1.0)

    def go_on(self):
        self.valet.type("continue")
        time.sleep(0.5)

    def test_1_before_enable_a_start_is_refused_and_nothing_moves(self):
        self.until("arms prepared", lambda: len(self.robot.told) == 4)
        for side in SIDES:
            self.assertEqual(self.robot.told[(side, "joint_command_timeout")], 0.2)
            self.assertEqual(self.robot.told[(side, "set_speed_ratio")], 0.5)
        since = self.valet.mark()
        self.valet.type("start")
        self.assertIn("refused", self.valet.await_line("command: start the trial", since=since))
        self.quiet_for(1.0)

    def test_2_enable_alone_moves_nothing_and_start_moves(self):
        self.begin()
        last = self.robot.commands[-1][2]
        self.assertEqual(last.mode, JointCommand.POSITION_MODE)
        self.assertEqual(len(last.names), 7)

    def test_3_a_wrench_that_is_no_number_holds(self):
        self.addCleanup(setattr, self.robot, "force", 0.0)
        self.robot.force = float("nan")
        self.holds_and_says("a number that is not finite")
        self.robot.force = 0.0
        self.moves()

    def test_4_stamps_that_jump_hold(self):
        self.addCleanup(setattr, self.robot, "shift", 0.0)
        for jump, words in ((-3.0, ("ms old", "went back")), (3.0, ("jumped ahead",))):
            self.robot.shift = jump
            self.holds_and_says(*words)
            self.robot.shift = 0.0
            self.moves()

    def test_4_a_squeezed_cuff_holds_until_the_hand_has_let_go(self):
        self.addCleanup(setattr, self.robot, "squeezed", None)
        self.robot.squeezed = "left"
        self.holds_and_says("left arm's cuff is squeezed")
        self.robot.squeezed = None
        self.moves()

    def test_5_another_order_of_joints_is_read_and_a_missing_one_holds(self):
        self.addCleanup(setattr, self.robot, "missing", None)
        self.robot.reverse = True
        self.moves()
        self.robot.missing = "left_w0"
        self.holds_and_says("the left arm's joints")
        self.robot.missing, self.robot.reverse = None, False
        self.moves()

    def test_6_a_stop_reaches_the_robot_and_only_reset_enable_and_start_lead_on(self):
        stops = self.robot.stops
        self.valet.type("stop")
        self.until("stopped", lambda: self.robot.stopped)
        self.assertGreater(self.robot.stops, stops)
        self.valet.await_line("emergency stop (software)")
        self.quiet_for(1.0)
        for refused in ("start", "continue"):
            self.valet.type(refused)
        self.quiet_for(1.0)
        self.valet.until_accepted("reset", "reset the stop")
        self.until("reset", lambda: not self.robot.stopped)
        self.quiet_for(1.0)
        self.begin()

    def test_7_a_stop_key_right_after_enable_is_a_stop(self):
        self.valet.type("stop")
        self.until("stopped", lambda: self.robot.stopped)
        self.valet.until_accepted("reset", "reset the stop")
        self.valet.until_accepted("enable", "enable the robot")
        self.until("enabled", lambda: self.robot.enabled)
        self.valet.type("stop")
        self.until("stopped again", lambda: self.robot.stopped)

    def test_8_a_publisher_with_another_definition_is_named_with_both_digests(self):
        class OtherImage(Image):
            _md5sum = "0123456789abcdef0123456789abcdef"

        topic = "/camera/depth/image_raw"
        since = self.valet.mark()
        other = rospy.Publisher(topic, OtherImage, queue_size=1)
        line = self.valet.await_line("publishes " + topic, since=since)
        for part in (rospy.get_name(), "sensor_msgs/Image (md5 %s)" % OtherImage._md5sum, "(md5 %s)" % Image._md5sum):
            self.assertIn(part, line)
        other.unregister()

    def test_9_the_way_out_says_that_a_stop_is_latched(self):
        self.valet.type("quit")
        self.assertEqual(self.valet.process.wait(30), 4)


if __name__ == "__main__":
    rostest.rosrun("valet", "node", NodeUnderTest)
