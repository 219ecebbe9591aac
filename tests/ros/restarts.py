#!/usr/bin/env python3
"""Master, simulator and node as processes of their own: each dies and comes back, and the trial holds and goes on.

Brings its own roscore along, because nobody may kill the master of a rostest. Takes a free port, leaves nothing behind.
"""
import os
import signal
import socket
import subprocess
import time
import unittest
import xmlrpc.client

import peer

import rostest


def free_port():
    with socket.socket() as any_port:
        any_port.bind(("127.0.0.1", 0))
        return any_port.getsockname()[1]


PORT = free_port()
URI = "http://127.0.0.1:%d/" % PORT
ENVIRONMENT = dict(os.environ, ROS_MASTER_URI=URI, ROS_IP="127.0.0.1")
# rostopic shows messages of packages that Debian does not have.
ENVIRONMENT["PYTHONPATH"] = os.pathsep.join(filter(None, [peer.make_messages(), os.environ.get("PYTHONPATH")]))
# In these phases the arms are led; in a hold they are told to stay.
UNDER_WAY = ("positioning", "dressing", "withdrawing")


def tool(*words, seconds=30):
    """Runs one of ROS' own tools and returns what it said; some of them never end by themselves."""
    process = subprocess.Popen(
        words, env=ENVIRONMENT, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, start_new_session=True
    )
    try:
        return process.communicate(timeout=seconds)[0]
    except subprocess.TimeoutExpired:
        os.killpg(process.pid, signal.SIGINT)
        try:
            return process.communicate(timeout=10)[0]
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
        while "/rosout" not in tool("rosnode", "list"):
            if time.monotonic() > end:
                raise AssertionError("no roscore")
            time.sleep(0.2)

    def kill(self):
        """The master dies at once; what roscore started beside it follows."""
        if self.process.poll() is None:
            os.kill(xmlrpc.client.ServerProxy(URI).getPid("/restarts")[2], signal.SIGKILL)
            os.killpg(self.process.pid, signal.SIGINT)
            try:
                self.process.wait(30)
            except subprocess.TimeoutExpired:
                os.killpg(self.process.pid, signal.SIGKILL)
                self.process.wait()


class Restarts(unittest.TestCase):
    """One trial through all of it, step by step in the order of the names."""

    @classmethod
    def setUpClass(cls):
        cls.master = Master()
        cls.simulator = cls.start_simulator()
        cls.node = peer.Valet("console", "--headless", "--no-record", env=ENVIRONMENT)
        cls.node.await_line("the ROS master answers")
        cls.node.until_accepted("enable", "enable the robot")

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

    def until(self, what, condition, act=None):
        end = time.monotonic() + 2 * peer.PATIENCE
        while not condition():
            if time.monotonic() > end:
                self.fail("not in time: %s; the node said:\n%s" % (what, "\n".join(self.node.lines[-30:])))
            if act:
                act()

    def phase(self):
        said = tool("rostopic", "echo", "-n", "1", "/valet/state")
        return next((line.split('"')[1] for line in said.splitlines() if line.startswith("phase:")), "")

    def operate(self):
        """What an operator does who wants the trial to go on: after a hold, or where one has come to its end."""
        for command in ("continue", "start"):
            self.node.type(command)
            time.sleep(0.5)

    def is_under_way(self):
        return self.phase() in UNDER_WAY and "left_s0" in tool(
            "rostopic", "echo", "-n", "1", "/robot/limb/left/joint_command", seconds=10
        )

    def goes_on(self):
        """The arms are led. A machine that is too busy for the beat may hold once more: then the operator continues."""
        self.until("a trial under way", self.is_under_way, self.operate)

    def stands(self):
        self.until("a trial that does not go on", lambda: self.phase() not in UNDER_WAY)

    def test_1_an_enable_reaches_a_robot_whose_topic_was_not_connected_yet(self):
        self.until("an enabled robot", lambda: "enabled: True" in tool("rostopic", "echo", "-n", "1", "/robot/state"))
        self.goes_on()

    def test_2_the_tools_of_ros_work_on_both(self):
        topics = tool("rostopic", "list")
        for topic in ("/robot/state", "/camera/depth/image_raw", "/tf_static", "/valet/state", "/diagnostics"):
            self.assertIn(topic, topics)
        nodes = tool("rosnode", "list")
        for node in ("/valet", "/simulated_baxter"):
            self.assertIn(node, nodes)
            self.assertIn("xmlrpc reply", tool("rosnode", "ping", "-c", "2", node))
            # rosrust does not tell its connections; what the master knows is told.
            self.assertIn("Publications:", tool("rosnode", "info", node))
        self.assertIn("average rate", tool("rostopic", "hz", "-w", "50", "/robot/joint_states", seconds=8))
        self.assertIn("Publishers", tool("rostopic", "info", "/valet/state"))
        self.assertIn("16UC1", tool("rostopic", "echo", "-n", "1", "--noarr", "/camera/depth/image_raw"))
        since = self.node.mark()
        self.assertIn("success: True", tool("rosservice", "call", "/valet/hold"))
        self.node.await_line("command: hold", since=since)
        self.stands()
        self.goes_on()

    def test_3_a_master_that_dies_holds_and_the_trial_goes_on_when_it_is_back(self):
        since = self.node.mark()
        self.master.kill()
        line = self.node.await_line("the ROS master does not answer", since=since)
        self.assertIn("start roscore again", line)
        since = self.node.mark()
        self.node.type("continue")
        self.assertIn("refused", self.node.await_line("command: continue", since=since))
        since = self.node.mark()
        type(self).master = Master()
        self.node.await_line("the ROS master answers", since=since)
        self.stands()
        both = {"/valet", "/simulated_baxter"}
        self.until("registered again", lambda: both <= set(tool("rosnode", "list").split()))
        self.goes_on()
        self.assertIn("success: True", tool("rosservice", "call", "/valet/hold"))
        self.stands()
        self.goes_on()

    def test_4_a_simulator_that_dies_holds_and_the_next_one_begins_anew(self):
        since = self.node.mark()
        self.simulator.process.kill()
        self.simulator.process.wait()
        self.stands()
        self.node.type("continue")
        # The node answers, and names what is missing.
        self.assertIn("refused", self.node.await_line("command: continue", since=since))
        self.node.await_line("ms old", "never", "not known", "not heard", since=since)
        type(self).simulator = self.start_simulator()
        # A robot that was switched off comes back disabled, and its arms are elsewhere: the trial that was under way cannot go
        # on from there, but the next one can begin.
        self.node.until_accepted("enable", "enable the robot")
        self.until("an enabled robot", lambda: "enabled: True" in tool("rostopic", "echo", "-n", "1", "/robot/state"))
        self.node.type("abort")
        self.goes_on()

    def test_5_rosnode_kill_ends_both(self):
        said = tool("rosnode", "kill", "/valet", "/simulated_baxter")
        self.assertIn("killed", said)
        for valet in (self.node, self.simulator):
            self.assertEqual(valet.process.wait(peer.PATIENCE), 0)


if __name__ == "__main__":
    rostest.rosrun("valet", "restarts", Restarts)
