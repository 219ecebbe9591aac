#!/usr/bin/env python3
"""The person's pose from a skeleton tracker on /tf: judged by its age, and held for where joints are hidden."""
import threading
import time
import unittest

import peer

peer.make_messages()

import rospy  # noqa: E402
import rostest  # noqa: E402
from tf2_msgs.msg import TFMessage  # noqa: E402

TRACKED = ["%s_%s_1" % (side, joint) for side in ("left", "right") for joint in ("hand", "elbow", "shoulder")]


class Skeleton(unittest.TestCase):
    """One trial that a hidden joint holds."""

    @classmethod
    def setUpClass(cls):
        rospy.init_node("skeleton_peer")
        cls.lock, cls.seen = threading.Lock(), {}
        rospy.Subscriber("/tf", TFMessage, cls.take, queue_size=64)
        cls.valet = peer.Valet("console", "--headless", "--no-record")
        cls.valet.await_line("the ROS master answers")

    @classmethod
    def tearDownClass(cls):
        cls.valet.end()

    @classmethod
    def take(cls, message):
        with cls.lock:
            for transform in message.transforms:
                cls.seen[transform.child_frame_id] = transform.header.stamp.to_sec()

    def ages(self):
        with self.lock:
            newest = max(self.seen.values(), default=0.0)
            return {frame: newest - self.seen.get(frame, 0.0) for frame in TRACKED}

    def until(self, what, condition, act=None):
        end = time.monotonic() + 2 * peer.PATIENCE
        while not condition():
            if time.monotonic() > end:
                self.fail("not in time: %s; ages %s; the node said:\n%s" % (what, self.ages(), "\n".join(self.valet.lines[-30:])))
            if act:
                act()
            time.sleep(0.2)

    def test_1_at_rest_all_joints_are_fresh_and_a_trial_begins(self):
        self.until("a skeleton", lambda: max(self.ages().values()) < 0.2)
        self.valet.until_accepted("enable", "enable the robot")
        self.valet.until_accepted("start", "start the trial")

    def test_2_a_hidden_joint_goes_stale_and_the_trial_holds_for_the_persons_pose(self):
        def said():
            return any("hold: the person's pose" in line for line in self.valet.lines)

        # A machine that is too busy for the beat holds for other reasons: the operator continues.
        self.until("a hold for the pose", said, lambda: self.valet.type("continue"))
        ages = self.ages()
        self.assertGreater(max(ages.values()), 0.5, ages)
        self.assertLess(min(ages.values()), 0.5, "the tracker goes on with what it sees: %s" % ages)

    def test_3_an_old_pose_is_refused_however_often_it_is_asked_for(self):
        since = self.valet.mark()
        self.valet.type("continue")
        line = self.valet.await_line("command: continue", since=since)
        self.assertIn("refused: the person's pose", line)


if __name__ == "__main__":
    rostest.rosrun("valet", "skeleton", Skeleton)
