#!/usr/bin/env python3
"""Real faults over real sockets: masters, simulators and consoles are killed, stopped and deceived, and nothing moves.

Speaks XML-RPC and TCPROS by hand, since well-behaved clients cannot misbehave. Every case has a master, a simulated robot
and a console on a pseudo-terminal of its own, and lets go of all of them at its end.
"""
import fcntl
import os
import pty
import resource
import shutil
import signal
import socket
import struct
import subprocess
import tempfile
import termios
import threading
import time
import unittest
import xmlrpc.client
from xmlrpc.server import SimpleXMLRPCServer

import rostest

HERE = os.path.dirname(os.path.realpath(__file__))
VALET = os.environ.get("VALET", os.path.join(HERE, "..", "..", "target", "debug", "valet"))
HOST = "127.0.0.1"
# A busy machine may take so long for what takes a moment.
PATIENCE = 40.0
ENDPOINT = "/robot/limb/right/endpoint_state"
COMMAND = "/robot/limb/right/joint_command"
ENDPOINT_TYPE = ("baxter_core_msgs/EndpointState", "44bea01d596ff699fa1447bec34167ac")
# Joints that change by less than an encoder's step stand still.
STILL = 4e-4


def free_port():
    with socket.socket() as probe:
        probe.bind((HOST, 0))
        return probe.getsockname()[1]


def until(what, condition, patience=PATIENCE):
    end = time.monotonic() + patience
    while time.monotonic() < end:
        found = condition()
        if found:
            return found
        time.sleep(0.02)
    raise AssertionError("%s did not happen within %.0f s" % (what, patience))


def header(**fields):
    body = b"".join(struct.pack("<I", len(pair)) + pair for pair in
                    (("%s=%s" % item).encode() for item in fields.items()))
    return struct.pack("<I", len(body)) + body


def read_exactly(connection, count):
    data = b""
    while len(data) < count:
        part = connection.recv(count - len(data))
        if not part:
            raise ConnectionError("closed")
        data += part
    return data


def read_block(connection):
    return read_exactly(connection, struct.unpack("<I", read_exactly(connection, 4))[0])


class Peer:
    """A node of our own: its slave API answers just enough."""

    def __init__(self, master, name):
        self.master, self.name = master, name
        self.ports = {}
        self.server = SimpleXMLRPCServer((HOST, 0), logRequests=False, allow_none=True)
        self.uri = "http://%s:%d/" % (HOST, self.server.server_address[1])
        self.server.register_function(lambda caller, topic, protocols: [1, "", ["TCPROS", HOST, self.ports[topic]]], "requestTopic")
        self.server.register_function(lambda *_: [1, "", 0], "publisherUpdate")
        self.server.register_function(lambda *_: [1, "", os.getpid()], "getPid")
        self.server.register_function(lambda *_: [1, "", 0], "shutdown")
        threading.Thread(target=self.server.serve_forever, daemon=True).start()

    def call(self, method, *parameters):
        code, text, value = getattr(xmlrpc.client.ServerProxy(self.master), method)(self.name, *parameters)
        assert code == 1, text
        return value

    def publish(self, topic, kind, behave):
        """Registers as a publisher that treats each subscriber's connection as `behave` does."""
        listener = socket.create_server((HOST, 0))
        self.ports[topic] = listener.getsockname()[1]

        def serve():
            while True:
                try:
                    connection, _ = listener.accept()
                except OSError:
                    return
                threading.Thread(target=self.treat, args=(behave, connection), daemon=True).start()

        threading.Thread(target=serve, daemon=True).start()
        self.call("registerPublisher", topic, kind, self.uri)

    @staticmethod
    def treat(behave, connection):
        try:
            behave(connection)
        except OSError:
            pass

    def connect(self, topic, publisher):
        """Asks a publisher for a topic and returns the connection, its header exchanged."""
        uri = self.call("lookupNode", publisher)
        _, _, protocol = xmlrpc.client.ServerProxy(uri).requestTopic(self.name, topic, [["TCPROS"]])
        connection = socket.create_connection((protocol[1], protocol[2]))
        connection.sendall(header(callerid=self.name, topic=topic, type="*", md5sum="*"))
        read_block(connection)
        return connection

    def close(self):
        self.server.shutdown()
        self.server.server_close()


class Listener:
    """Reads a topic of one publisher and keeps what came, with its time."""

    def __init__(self, peer, topic, publisher):
        self.messages = []
        self.connection = peer.connect(topic, publisher)
        threading.Thread(target=self.read, daemon=True).start()

    def read(self):
        try:
            with self.connection:
                while True:
                    message = read_block(self.connection)
                    self.messages.append((time.monotonic(), message))
        except OSError:
            pass

    @property
    def newest(self):
        return self.messages[-1][1] if self.messages else None

    def since(self, moment):
        return [message for at, message in list(self.messages) if at > moment]


def state(message):
    """Phase and cause of a valet_msgs/State."""
    if message is None:
        return "", ""
    at, texts = 12, []
    for _ in range(6):
        length = struct.unpack_from("<I", message, at)[0]
        texts.append(message[at + 4:at + 4 + length].decode())
        at += 4 + length
    return texts[2], texts[5]


def commanded(message):
    """Joint positions of a baxter_core_msgs/JointCommand."""
    count = struct.unpack_from("<I", message, 4)[0]
    return struct.unpack_from("<%dd" % count, message, 8)


class Laboratory:
    """A master, a simulated robot, and a console on a terminal."""

    def __init__(self, record=None, limit=None):
        self.port = free_port()
        self.home = tempfile.mkdtemp(prefix="valet_faults_")
        self.environment = dict(os.environ, ROS_MASTER_URI="http://%s:%d" % (HOST, self.port), ROS_IP=HOST,
                                HOME=self.home, ROS_LOG_DIR=self.home, TERM="xterm-256color", LANG="C.UTF-8")
        for name in ("XDG_DATA_HOME", "XDG_STATE_HOME", "XDG_CONFIG_HOME", "ROS_HOSTNAME", "ROS_NAMESPACE"):
            self.environment.pop(name, None)
        self.processes, self.terminals, self.screens = [], [], {}
        self.start_master()
        self.start_simulator()
        self.peer = Peer(self.environment["ROS_MASTER_URI"], "/fault_peer")
        self.console = self.start_console(record=record, limit=limit)
        self.state = self.listen("/valet/state")

    def start_master(self):
        self.master = self.spawn(["rosmaster", "--core", "-p", str(self.port), "-w", "3"])
        until("the master", self.master_answers)

    def master_answers(self):
        try:
            return xmlrpc.client.ServerProxy(self.environment["ROS_MASTER_URI"]).getPid("/x")[0] == 1
        except OSError:
            return False

    def start_simulator(self):
        self.simulator = self.spawn([VALET, "sim", "--seed", "5"])

    def spawn(self, command):
        process = subprocess.Popen(command, env=self.environment, stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL,
                                   stderr=subprocess.DEVNULL)
        self.processes.append(process)
        return process

    def start_console(self, *arguments, record=None, limit=None):
        terminal, other = pty.openpty()
        fcntl.ioctl(other, termios.TIOCSWINSZ, struct.pack("HHHH", 40, 120, 0, 0))
        command = [VALET, "console"] + (["--record", record] if record else []) + list(arguments)

        def prepare():
            os.setsid()
            if limit:
                # As on a full disk, writing fails; the signal that comes with this limit is none of a full disk's.
                signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
                resource.setrlimit(resource.RLIMIT_FSIZE, (limit, limit))

        process = subprocess.Popen(command, env=self.environment, stdin=other, stdout=other, stderr=other, preexec_fn=prepare)
        os.close(other)
        self.processes.append(process)
        process.terminal = terminal
        self.screens[process.pid] = b""

        def read():
            try:
                while True:
                    self.screens[process.pid] = (self.screens[process.pid] + os.read(terminal, 65536))[-200000:]
            except OSError:
                pass

        threading.Thread(target=read, daemon=True).start()
        return process

    def press(self, keys, console=None):
        os.write((console or self.console).terminal, keys.encode())
        time.sleep(0.4)

    def listen(self, topic, node="/valet"):
        def attempt():
            try:
                return Listener(self.peer, topic, node)
            except (OSError, AssertionError, xmlrpc.client.Error, TypeError):
                return None
        return until("a listener of " + topic, attempt)

    def phase(self):
        return state(self.state.newest)[0]

    def cause(self):
        return state(self.state.newest)[1]

    def move(self):
        """Enables the robot, starts a trial, and waits until an arm moves."""
        until("a state", lambda: self.phase() == "no trial")
        time.sleep(1.0)

        def enabled():
            self.press("E")
            self.press("y\r")
            return self.robot_says_enabled()

        self.robot = self.listen("/robot/state", "/simulated_baxter") if not hasattr(self, "robot") else self.robot
        until("an enabled robot", enabled)

        def started():
            self.press("S")
            self.press("y\r")
            return self.phase() in ("positioning", "dressing", "holding")

        until("a trial", started)
        self.commands = self.listen(COMMAND)

        def moving():
            if self.phase() == "holding":
                # A machine that is too busy for the beat holds: the operator goes on.
                self.go_on()
            return self.moves()

        until("an arm that moves", moving)

    def go_on(self):
        self.press("p")
        self.press("y\r")

    def robot_says_enabled(self):
        return self.robot.newest is not None and self.robot.newest[1] == 1

    def robot_says_stopped(self):
        return self.robot.newest is not None and self.robot.newest[2] == 1

    def moves(self, span=0.3):
        begin = time.monotonic()
        time.sleep(span)
        sent = [commanded(message) for message in self.commands.since(begin)]
        return bool(sent) and max(abs(a - b) for a, b in zip(sent[0], sent[-1])) > STILL

    def close(self):
        for process in self.processes:
            try:
                process.send_signal(signal.SIGCONT)
                process.kill()
            except OSError:
                pass
            process.wait()
        self.peer.close()
        shutil.rmtree(self.home, ignore_errors=True)


class Faults(unittest.TestCase):
    """One fault each."""

    def setUp(self):
        self.laboratory = None

    def tearDown(self):
        if self.laboratory:
            self.laboratory.close()

    def begin(self, **options):
        self.laboratory = Laboratory(**options)
        self.laboratory.move()
        return self.laboratory

    def holds(self, laboratory, words=""):
        def held():
            if laboratory.phase() != "holding":
                return False
            if words in laboratory.cause():
                return True
            # A machine that is too busy for the beat held before: the operator goes on, and the fault stands.
            laboratory.go_on()
            return False

        until("a hold for '%s'" % words, held)
        # Braking takes less than a second.
        time.sleep(1.0)
        self.assertFalse(laboratory.moves(1.0), "it moves in a hold")

    def test_killed_and_restarted_simulator(self):
        laboratory = self.begin()
        laboratory.simulator.kill()
        self.holds(laboratory)
        laboratory.start_simulator()
        time.sleep(4.0)
        self.assertEqual(laboratory.phase(), "holding")
        self.assertFalse(laboratory.moves(0.5), "it moves although nobody acted")

    def test_stopped_and_continued_simulator(self):
        laboratory = self.begin()
        laboratory.simulator.send_signal(signal.SIGSTOP)
        self.holds(laboratory)
        laboratory.simulator.send_signal(signal.SIGCONT)
        time.sleep(1.5)
        self.assertEqual(laboratory.phase(), "holding")
        self.assertFalse(laboratory.moves(0.5), "it moves although nobody acted")

    def test_killed_and_restarted_master(self):
        laboratory = self.begin()
        laboratory.master.kill()
        laboratory.master.wait()
        self.holds(laboratory, "master")
        laboratory.start_master()

        def registered():
            publishers = laboratory.peer.call("getSystemState")[0]
            return any(topic == COMMAND and "/valet" in nodes for topic, nodes in publishers)

        until("valet's own registration with the new master", registered)
        self.assertEqual(laboratory.phase(), "holding")

    def test_foreign_publisher_is_named_and_held_as_long_as_it_is_there(self):
        laboratory = self.begin()
        intruder = Peer(laboratory.peer.master, "/teleoperation")
        intruder.publish(COMMAND, "baxter_core_msgs/JointCommand", lambda connection: time.sleep(60))
        self.holds(laboratory, "/teleoperation")
        laboratory.go_on()
        time.sleep(1.0)
        self.assertEqual(laboratory.phase(), "holding", "it still publishes")
        intruder.close()

    def test_second_valet_is_named_and_both_hold(self):
        laboratory = self.begin()
        laboratory.start_console("__name:=valet_two")
        self.holds(laboratory, "/valet_two")

    def test_second_valet_of_the_same_name_is_named_and_the_first_holds(self):
        laboratory = self.begin()
        laboratory.start_console()
        self.holds(laboratory, "a second /valet")

    def test_liars_neither_move_nor_kill(self):
        laboratory = self.begin()
        kind, md5 = ENDPOINT_TYPE
        good = header(callerid="/liar", type=kind, md5sum=md5, topic=ENDPOINT)

        def greet_and_send(data):
            def behave(connection):
                read_block(connection)
                connection.sendall(good + data)
                time.sleep(60)
            return behave

        liars = {
            "wrong_md5": lambda connection: (read_block(connection), connection.sendall(header(
                callerid="/liar", type=kind, md5sum="0" * 32, topic=ENDPOINT)), time.sleep(60)),
            "oversized": greet_and_send(struct.pack("<I", 0xFFFFFFFF) + b"x" * 64),
            "cut": greet_and_send(struct.pack("<I", 400) + b"x" * 40),
            "garbage": greet_and_send(struct.pack("<I", 8) + b"\xff" * 8),
            "huge_header": lambda connection: (connection.sendall(b"\xff" * 64), time.sleep(60)),
            "closes": lambda connection: connection.close(),
            "silent": lambda connection: time.sleep(60),
        }
        peers = []
        for name, behave in liars.items():
            peer = Peer(laboratory.peer.master, "/liar_" + name)
            peer.publish(ENDPOINT, kind, behave)
            peers.append(peer)
        time.sleep(3.0)
        self.assertIsNone(laboratory.console.poll(), "the console lives")
        self.stop_arrives(laboratory)
        for peer in peers:
            peer.close()

    def test_half_open_listeners_do_not_keep_a_stop_from_the_robot(self):
        laboratory = self.begin()
        # Greeted and never read from again; and never greeted at all.
        idle = [laboratory.peer.connect(topic, "/valet") for topic in (COMMAND, "/robot/set_super_stop")]
        for connection in idle:
            address = connection.getpeername()
            idle.append(socket.create_connection(address)) if len(idle) < 4 else None
        time.sleep(1.0)
        self.stop_arrives(laboratory)

    def stop_arrives(self, laboratory):
        laboratory.press(" ")
        until("a stopped robot", laboratory.robot_says_stopped)
        until("a stop on the screen", lambda: laboratory.phase() == "stopped")
        time.sleep(0.5)
        self.assertFalse(laboratory.moves(0.5))

    def test_killed_console_leaves_a_robot_that_holds(self):
        laboratory = self.begin()
        laboratory.console.kill()
        time.sleep(1.0)
        begin = time.monotonic()
        joints = laboratory.listen("/robot/joint_states", "/simulated_baxter")
        time.sleep(1.0)
        self.assertEqual(laboratory.commands.since(begin), [])
        sent = [message[-8 * 34:] for message in joints.since(begin) if len(message) > 400]
        self.assertTrue(len(sent) > 20)
        self.assertEqual(sent[5], sent[-1], "the robot holds by its own time-out")

    def test_console_that_was_stopped_holds_when_it_goes_on(self):
        laboratory = self.begin()
        laboratory.console.send_signal(signal.SIGSTOP)
        time.sleep(2.0)
        laboratory.console.send_signal(signal.SIGCONT)
        self.holds(laboratory)

    def test_terminal_that_goes_away_ends_the_commands(self):
        laboratory = self.begin()
        os.close(laboratory.console.terminal)
        until("the end of the console", lambda: laboratory.console.poll() is not None)
        begin = time.monotonic()
        time.sleep(0.5)
        self.assertEqual(laboratory.commands.since(begin), [])

    def test_full_disk_holds_and_says_so(self):
        record = tempfile.mkdtemp(prefix="valet_full_")
        try:
            laboratory = Laboratory(record=record, limit=400_000)
            self.laboratory = laboratory
            laboratory.move()
            self.holds(laboratory, "record")
        finally:
            shutil.rmtree(record, ignore_errors=True)


if __name__ == "__main__":
    rostest.rosrun("valet", "faults", Faults)
