#!/usr/bin/env python3
"""Each launch file really launched, and every topic that the layouts name looked for in what runs then."""
import glob
import json
import os
import shutil
import signal
import subprocess
import tempfile
import time
import unittest
import xml.etree.ElementTree

import peer

MESSAGES = peer.make_messages()

import rosbag  # noqa: E402
import rosgraph  # noqa: E402
import roslib.message  # noqa: E402
import rospy  # noqa: E402
import rostest  # noqa: E402
import yaml  # noqa: E402
from valet_msgs.msg import State  # noqa: E402

LAUNCH = os.path.join(peer.HERE, "..", "..", "launch")
TERMINAL = os.path.join(peer.HERE, "terminal.py")
BINARY = "binary:=valet_node"


class Launched:
    """A launch file at work."""

    def __init__(self, name, *arguments):
        self.log = tempfile.TemporaryFile("w+")
        # rosbag reads the messages of packages that Debian does not have.
        path = os.pathsep.join(filter(None, [MESSAGES, os.environ.get("PYTHONPATH")]))
        self.process = subprocess.Popen(
            ["roslaunch", os.path.join(LAUNCH, name), *arguments],
            env=dict(os.environ, PYTHONPATH=path),
            stdout=self.log,
            stderr=subprocess.STDOUT,
            start_new_session=True,
        )

    def said(self):
        self.log.seek(0)
        return self.log.read()

    def end(self):
        if self.process.poll() is None:
            self.process.send_signal(signal.SIGINT)
            try:
                self.process.wait(peer.PATIENCE)
            except subprocess.TimeoutExpired:
                os.killpg(self.process.pid, signal.SIGKILL)
        return self.process.wait()


class LaunchFiles(unittest.TestCase):
    """One launch file after the other, in the order of the names."""

    @classmethod
    def setUpClass(cls):
        rospy.init_node("launch_peer")
        cls.master = rosgraph.Master("/launch_peer")
        cls.folder = tempfile.mkdtemp(prefix="valet_launch_")
        cls.simulation = Launched("simulation.launch", BINARY, "seed:=5")
        cls.state = None
        rospy.Subscriber("/valet/state", State, cls.take, queue_size=1)

    @classmethod
    def tearDownClass(cls):
        cls.simulation.end()
        shutil.rmtree(cls.folder, ignore_errors=True)

    @classmethod
    def take(cls, message):
        cls.state = message

    def publishers(self, topic):
        return dict(self.master.getSystemState()[0]).get(topic, [])

    def until(self, what, condition, launched):
        end = time.monotonic() + peer.PATIENCE
        while not condition():
            if time.monotonic() > end or launched.process.poll() is not None:
                self.fail("not in time: %s; roslaunch said:\n%s" % (what, launched.said()))
            time.sleep(0.2)

    def console(self, name, *arguments):
        """Launches a file that brings a console along, until it publishes what it does."""
        type(self).state = None
        launched = Launched(name, BINARY, "terminal:=" + TERMINAL, *arguments)
        self.addCleanup(launched.end)
        self.until("a state of valet", lambda: self.state is not None, launched)
        return launched

    def test_1_simulation(self):
        self.until("a robot", lambda: self.publishers("/robot/state") == ["/simulated_baxter"], self.simulation)

    def test_2_console_and_what_the_layouts_show(self):
        self.console("console.launch", "strategy:=gmm", "profile:=participant-01", "record:=" + self.folder)
        self.assertEqual(self.state.strategy, "gmm")
        types = dict(self.master.getTopicTypes())
        for topic, fields in layouts():
            self.assertTrue(self.publishers(topic), topic)
            message = roslib.message.get_message_class(types[topic])()
            for field in fields:
                self.assertTrue(hasattr(message, field), "%s has no %s" % (topic, field))
                message = getattr(message, field)

    def test_3_moveit(self):
        self.console("moveit.launch")
        self.assertEqual(self.publishers("/robot/limb/left/joint_command"), ["/valet"])

    def test_4_recording_and_replay(self):
        recording = Launched("recording.launch", "out:=" + os.path.join(self.folder, "bag"))
        self.addCleanup(recording.end)
        self.until("a bag", lambda: glob.glob(os.path.join(self.folder, "bag*.active")), recording)
        time.sleep(10.0)
        recording.end()
        self.simulation.end()
        (bag,) = glob.glob(os.path.join(self.folder, "bag*.bag"))
        with rosbag.Bag(bag) as read:
            topics = read.get_type_and_topic_info().topics
        for topic in ("/robot/state", "/robot/joint_states", "/robot/limb/left/endpoint_state", "/tf"):
            self.assertGreater(topics[topic].message_count, 20, topic)
        self.console("replay.launch", "bag:=" + bag, "delay:=1")
        self.assertEqual(self.publishers("/robot/limb/left/joint_command"), [], "a replay commands nothing")
        self.assertTrue(any("player" in node for node in self.publishers("/robot/state")))


def layouts():
    """The topics that the layouts name, each with the fields that lead to what is shown."""
    with open(os.path.join(LAUNCH, "valet.foxglove.json")) as file:
        panels = json.load(file)["configById"].values()
    for path in [path["value"] for panel in panels for path in panel.get("paths", [])]:
        topic, *fields = path.split(".")
        yield topic, fields
    curves = [curve.get("name") for curve in xml.etree.ElementTree.parse(os.path.join(LAUNCH, "valet.plotjuggler.xml")).iter("curve")]
    assert curves, "a layout without curves"
    for curve in curves:
        # PlotJuggler puts no mark between a topic and its fields.
        topic, _, fields = curve.partition("/endpoint_state/")
        yield topic + "/endpoint_state", fields.split("/")
    with open(os.path.join(LAUNCH, "valet.rviz")) as file:
        displays = yaml.safe_load(file)["Visualization Manager"]["Displays"]
    named = [display[key] for display in displays for key in ("Topic", "Marker Topic") if key in display]
    assert named, "a configuration without topics"
    yield from ((topic, []) for topic in named)


if __name__ == "__main__":
    rostest.rosrun("valet", "launch_files", LaunchFiles)
