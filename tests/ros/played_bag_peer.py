#!/usr/bin/env python3
"""A bag of a Baxter's topics, played by rosbag itself, drives `valet console --dry-run`: decisions, but no commands."""
import glob
import os
import queue
import subprocess
import tempfile
import threading
import time
import unittest

import rosgraph
import rostest

VALET = os.path.join(os.path.dirname(os.path.realpath(__file__)), "..", "..", "scripts", "valet_node")
# Commands in a bag are those of another trial: they are not played.
TOPICS = ["/robot/limb/left/endpoint_state", "/robot/limb/right/endpoint_state", "/robot/joint_states", "/robot/state", "/tf"]
COMMANDS = ["joint_command", "set_super_stop", "set_super_reset", "set_super_enable", "set_speed_ratio"]


def valet(*arguments):
    subprocess.check_call([VALET] + list(arguments))


def bag_of_a_trial(folder):
    """Records a simulated trial and exports it: the topics that a lab's own bag of a Baxter has."""
    valet("demo", "--headless", "--seed", "4", "--record", folder)
    (journal,) = glob.glob(os.path.join(folder, "*.mcap"))
    bag = os.path.join(folder, "trial.bag")
    valet("export", journal, "--out", bag)
    return bag


class Console:
    """The console without a screen, with its lines as they come."""

    def __init__(self, folder):
        self.process = subprocess.Popen(
            [VALET, "console", "--dry-run", "--headless", "--record", folder],
            stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True, bufsize=1)
        self.lines = queue.Queue()
        threading.Thread(target=self.read, daemon=True).start()

    def read(self):
        for line in self.process.stdout:
            self.lines.put(line.rstrip())

    def ask(self, word):
        self.process.stdin.write(word + "\n")
        self.process.stdin.flush()

    def wait_for(self, words, seconds):
        """The first line with one of the words, or None."""
        until = time.time() + seconds
        while time.time() < until:
            try:
                line = self.lines.get(timeout=0.1)
            except queue.Empty:
                continue
            print(line)
            if any(word in line for word in words):
                return line
        return None


class PlayedBag(unittest.TestCase):
    """What the console makes of a bag."""

    def test_it_decides_everything_and_commands_nothing(self):
        with tempfile.TemporaryDirectory() as folder:
            bag = bag_of_a_trial(folder)
            console = Console(os.path.join(folder, "dry"))
            player = subprocess.Popen(["rosbag", "play", "--quiet", "--delay=3", bag, "--topics"] + TOPICS)
            try:
                begun = None
                for _ in range(20):
                    console.ask("start")
                    line = console.wait_for(["the trial begins", "refused"], 2)
                    if line and "the trial begins" in line:
                        begun = line
                        break
                    time.sleep(1)
                self.assertIsNotNone(begun, "the trial never began")
                # The recorded arms go their own way, so the dry run may hold: the operator lets it go on until it has moved.
                for _ in range(10):
                    line = console.wait_for(["iteration 1 begins", "hold:"], 40)
                    if line is None or "iteration 1 begins" in line:
                        break
                    console.ask("continue")
                self.assertIsNotNone(line, "the dry run never came to the first pass")
                publishers, _, _ = rosgraph.Master("/peer").getSystemState()
                commanded = [topic for topic, _ in publishers if any(word in topic for word in COMMANDS)]
                self.assertEqual(commanded, [], "a dry run must not even advertise a command")
            finally:
                console.ask("quit")
                player.terminate()
                player.wait()
                self.assertEqual(console.process.wait(20), 0)
            (journal,) = glob.glob(os.path.join(folder, "dry", "*.mcap"))
            valet("replay", journal, "--check")
            decided = subprocess.check_output([VALET, "export", journal, "--format", "csv"], text=True)
            print(decided)
            with open(os.path.join(folder, "dry", os.path.basename(journal)[:-5] + ".csv", "setpoints.csv")) as table:
                self.assertGreater(len(table.readlines()), 10, "the dry run decided no motion")


if __name__ == "__main__":
    rostest.rosrun("valet", "played_bag", PlayedBag)
