#!/usr/bin/env python3
"""Master, simulator and node as processes of their own: each dies and comes back, and the trial holds and goes on.

Not a rostest, because a rostest cannot kill its own master. Takes a free port, leaves nothing behind.
"""
import os
import signal
import socket
import subprocess
import time
import unittest

import peer


def free_port():
    with socket.socket() as any_port:
        any_port.bind(("127.0.0.1", 0))
        return any_port.getsockname()[1]


PORT = free_port()
ENVIRONMENT = dict(os.environ, ROS_MASTER_URI="http://127.0.0.1:%d/" % PORT, ROS_IP="127.0.0.1")
# rostopic shows messages of packages that Debian does not have.
ENVIRONMENT["PYTHONPATH"] = os.pathsep.join(filter(None, [peer.make_messages(), os.environ.get("PYTHONPATH")]))


def tool(*words, seconds=20):
    """Runs one of ROS' own tools and returns what it said; some of them never end by themselves."""
    process = subprocess.Popen(
        words, env=ENVIRONMENT, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, start_new_session=True
    )
    try:
        return process.communicate(timeout=seconds)[0]
    except subprocess.TimeoutExpired:
        os.killpg(process.pid, signal.SIGINT)
        try:
            return process.communicate(timeout=5)[0]
        except subprocess.TimeoutExpired:
            os.killpg(process.pid, signal.SIGKILL)
            return process.communicate()[0]


class Master:
    """A real roscore on a port of its own."""

    def __init__(self):
        words = ["roscore", "-p", str(PORT)]
        quiet = {"stdout": subprocess.DEVNULL, "stderr": subprocess.DEVNULL}
        self.process = subprocess.Popen(words, env=ENVIRONMENT, start_new_session=True, **quiet)
        end = time.monotonic() + peer.PATIENCE
        while time.monotonic() < end:
            if "/rosout" in tool("rosnode", "list"):
                return
            time.sleep(0.2)
        raise AssertionError("no roscore")

    def kill(self):
        if self.process.poll() is None:
            os.killpg(self.process.pid, signal.SIGINT)
            self.process.wait(30)


class Restarts(unittest.TestCase):
    """One trial through all of it, step by step in the order of the names."""

    @classmethod
    def setUpClass(cls):
        cls.master = Master()
        cls.simulator = cls.start_simulator()
        cls.node = peer.Valet("console", "--headless", "--no-record", env=ENVIRONMENT)
        cls.node.await_line("the ROS master answers")
        cls.node.until_accepted("enable", "enable the robot")
        cls.node.until_accepted("start", "start the trial")

    @classmethod
    def start_simulator(cls):
        simulator = peer.Valet("sim", "--seed", "1", env=ENVIRONMENT)
        simulator.await_line("simulated Baxter")
        return simulator

    @classmethod
    def tearDownClass(cls):
        cls.node.end()
        cls.simulator.end()
        cls.master.kill()

    def goes_on(self):
        """The operator continues, and the arms are commanded."""
        self.node.until_accepted("continue", "continue")
        self.moves()

    def says_why(self, since):
        """The node names the silence, also to an operator who wants to go on."""
        self.node.type("continue")
        self.node.await_line("ms old", "disabled", "emergency stop", "refused", since=since)

    def moves(self):
        said = tool("rostopic", "echo", "-n", "1", "/robot/limb/left/joint_command", seconds=30)
        self.assertIn("left_s0", said)

    def test_1_the_tools_of_ros_work_on_both(self):
        topics = tool("rostopic", "list")
        for topic in ("/robot/state", "/camera/depth/image_raw", "/tf_static", "/valet/state", "/diagnostics"):
            self.assertIn(topic, topics)
        nodes = tool("rosnode", "list")
        for node in ("/valet", "/simulated_baxter"):
            self.assertIn(node, nodes)
            self.assertIn("xmlrpc reply", tool("rosnode", "ping", "-c", "2", node))
        self.assertIn("average rate", tool("rostopic", "hz", "-w", "50", "/robot/joint_states", seconds=6))
        self.assertIn("Publishers", tool("rostopic", "info", "/valet/state"))
        self.assertIn("enabled: True", tool("rostopic", "echo", "-n", "1", "--noarr", "/robot/state"))
        self.assertIn("16UC1", tool("rostopic", "echo", "-n", "1", "--noarr", "/camera/depth/image_raw"))
        since = self.node.mark()
        self.assertIn("success: True", tool("rosservice", "call", "/valet/hold"))
        self.node.await_line("command: hold", since=since)
        self.goes_on()

    def test_2_a_master_that_dies_holds_and_the_trial_goes_on_when_it_is_back(self):
        since = self.node.mark()
        self.master.kill()
        line = self.node.await_line("the ROS master does not answer", since=since)
        self.assertIn("start roscore again", line)
        since = self.node.mark()
        type(self).master = Master()
        self.node.await_line("the ROS master answers", since=since)
        end = time.monotonic() + peer.PATIENCE
        while not {"/valet", "/simulated_baxter"} <= set(tool("rosnode", "list").split()):
            self.assertLess(time.monotonic(), end, "not registered again")
        self.goes_on()
        self.assertIn("success: True", tool("rosservice", "call", "/valet/hold"))
        self.goes_on()

    def test_3_a_simulator_that_dies_holds_and_the_next_one_begins_anew(self):
        since = self.node.mark()
        self.simulator.process.kill()
        self.says_why(since)
        type(self).simulator = self.start_simulator()
        # A robot that was switched off comes back disabled, and its arms are elsewhere: the trial that was under way cannot go
        # on from there, but the next one can begin.
        self.node.until_accepted("enable", "enable the robot")
        self.node.until_accepted("abort", "abort the trial")
        self.node.until_accepted("start", "start the trial")
        self.moves()

    def test_4_rosnode_kill_ends_both(self):
        said = tool("rosnode", "kill", "/valet", "/simulated_baxter")
        self.assertIn("killed", said)
        for valet in (self.node, self.simulator):
            self.assertEqual(valet.process.wait(20), 0)


if __name__ == "__main__":
    unittest.main(verbosity=2)
