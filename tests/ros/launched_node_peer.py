#!/usr/bin/env python3
"""A node that roslaunch started under a namespace, with remappings and private parameters, seen from a rospy peer."""
import threading
import time
import unittest

import peer

peer.make_messages()

import rosgraph  # noqa: E402
import rospy  # noqa: E402
import rostest  # noqa: E402
from diagnostic_msgs.msg import DiagnosticArray  # noqa: E402
from sensor_msgs.msg import Image  # noqa: E402
from std_srvs.srv import Trigger  # noqa: E402
from valet_msgs.msg import State  # noqa: E402

NODE = "/laboratory/dresser"
DEPTH = "/laboratory/xtion/depth"


class LaunchedNode(unittest.TestCase):
    """Names, parameters, services and diagnostics."""

    @classmethod
    def setUpClass(cls):
        rospy.init_node("launched_node_peer")
        cls.changed = threading.Condition()
        cls.state, cls.diagnostics = None, []
        rospy.Subscriber(NODE + "/state", State, cls.take_state, queue_size=1)
        rospy.Subscriber("/diagnostics", DiagnosticArray, cls.take_diagnostics, queue_size=8)
        cls.image = rospy.Publisher(DEPTH, Image, queue_size=1)

    @classmethod
    def take_state(cls, message):
        with cls.changed:
            cls.state = message
            cls.changed.notify_all()

    @classmethod
    def take_diagnostics(cls, message):
        with cls.changed:
            cls.diagnostics.append((time.monotonic(), message))
            cls.changed.notify_all()

    def until(self, what, condition, act=None):
        end = time.monotonic() + peer.PATIENCE
        while time.monotonic() < end:
            if act:
                act()
            with self.changed:
                if condition():
                    return
                self.changed.wait(0.05)
        self.fail("not in time: " + what)

    def depth_status(self):
        """The newest diagnostic of the depth image: its values by name."""
        for _, message in reversed(self.diagnostics):
            for status in message.status:
                if status.name.endswith(": " + DEPTH):
                    return {pair.key: pair.value for pair in status.values}
        return {}

    def test_1_private_parameters_choose_strategy_and_dry_run(self):
        self.until("a state", lambda: self.state is not None)
        self.until("the strategy", lambda: self.state.strategy == "gmm")
        publishers = dict(rosgraph.Master("/launched_node_peer").getSystemState()[0])
        self.assertIn(NODE + "/state", publishers)
        self.assertNotIn("/robot/limb/left/joint_command", publishers, "a dry run does not even advertise commands")

    def test_2_remapped_topics_are_heard_and_watched_under_their_new_names(self):
        good = Image(height=2, width=2, encoding="16UC1", step=4, data=bytes(8))
        self.until(
            "heard and watched",
            lambda: self.depth_status().get("publishers") == rospy.get_name()
            and self.depth_status().get("age_seconds") != "never",
            lambda: self.image.publish(good),
        )
        self.assertEqual(self.depth_status()["unusable"], "0")

    def test_3_an_image_whose_size_and_data_disagree_is_counted_and_not_used(self):
        bad = Image(height=480, width=640, encoding="16UC1", step=1280, data=bytes(7))
        self.until(
            "counted",
            lambda: int(self.depth_status().get("unusable", "0")) > 0,
            lambda: self.image.publish(bad),
        )

    def test_4_diagnostics_come_about_once_a_second(self):
        begin = time.monotonic()
        self.until("six", lambda: len([at for at, _ in self.diagnostics if at > begin]) >= 6)
        times = [at for at, _ in self.diagnostics if at > begin][:6]
        rate = 5.0 / (times[-1] - times[0])
        self.assertTrue(0.5 < rate < 1.5, rate)

    def test_5_any_node_may_hold_and_stop_and_none_may_start(self):
        services = [name for name, _ in rosgraph.Master("/launched_node_peer").getSystemState()[2]]
        own = sorted(name for name in services if name.startswith(NODE + "/"))
        self.assertEqual(own, [NODE + "/hold", NODE + "/stop"])
        for name in own:
            answer = rospy.ServiceProxy(name, Trigger)()
            self.assertTrue(answer.success, answer.message)
        self.until("stopped", lambda: self.state.safety == "stopped")


if __name__ == "__main__":
    rostest.rosrun("valet", "launched_node", LaunchedNode)
