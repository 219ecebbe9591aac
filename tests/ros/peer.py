"""What the rospy peers share: Python classes of baxter_core_msgs, and valet as a process whose lines are read."""
import os
import subprocess
import sys
import tempfile
import threading
import time

HERE = os.path.dirname(os.path.realpath(__file__))
PATIENCE = 60.0


def make_messages():
    """Writes the Python classes of the packages that Debian does not have from msg/, and puts them on the path."""
    messages = os.path.join(HERE, "..", "..", "msg")
    folder = tempfile.mkdtemp(prefix="valet_messages_")
    includes = []
    for package in os.listdir(messages):
        includes += ["-I%s:%s" % (package, os.path.join(messages, package, "msg"))]
    # std_msgs/Header is built into rosrust and so not among our definitions.
    includes += ["-Istd_msgs:/usr/share/std_msgs/msg"]
    generator = "/usr/lib/genpy/genmsg_py.py"
    for package in ("baxter_core_msgs", "valet_msgs"):
        out = os.path.join(folder, package, "msg")
        os.makedirs(out)
        source = os.path.join(messages, package, "msg")
        files = [os.path.join(source, name) for name in sorted(os.listdir(source))]
        subprocess.check_call([generator, "-p", package, "-o", out] + includes + files)
        subprocess.check_call([generator, "--initpy", "-p", package, "-o", out])
        open(os.path.join(folder, package, "__init__.py"), "w").close()
    sys.path.insert(0, folder)
    return folder


class Valet:
    """A valet process: its lines are kept, and commands may be typed."""

    def __init__(self, *arguments, env=None):
        program = os.path.join(HERE, "..", "..", "scripts", "valet_node")
        self.process = subprocess.Popen(
            [program, *arguments],
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            stderr=subprocess.STDOUT,
            text=True,
            bufsize=1,
            env=dict(os.environ, **(env or {})),
        )
        self.lines = []
        self.changed = threading.Condition()
        threading.Thread(target=self.read, daemon=True).start()

    def read(self):
        for line in self.process.stdout:
            with self.changed:
                self.lines.append(line.rstrip())
                self.changed.notify_all()

    def type(self, line):
        try:
            self.process.stdin.write(line + "\n")
            self.process.stdin.flush()
        except BrokenPipeError:
            said = "\n".join(self.lines[-30:])
            raise AssertionError("valet has ended with %s before `%s`:\n%s" % (self.process.wait(), line, said)) from None

    def mark(self):
        """Where the lines end now: what is waited for must come after it."""
        with self.changed:
            return len(self.lines)

    def await_line(self, *texts, since=0, patience=PATIENCE):
        """Waits for a line that holds one of the texts, and returns it."""
        end = time.monotonic() + patience
        with self.changed:
            while True:
                for line in self.lines[since:]:
                    if any(text in line for text in texts):
                        return line
                rest = end - time.monotonic()
                if rest <= 0 or not self.changed.wait(rest):
                    raise AssertionError("no line with %s in:\n%s" % (texts, "\n".join(self.lines[since:])))

    def until_accepted(self, command, answer, patience=PATIENCE):
        """Types a command until it is accepted, as an operator does who reads why it was refused."""
        end = time.monotonic() + patience
        while True:
            since = self.mark()
            self.type(command)
            line = self.await_line("command: " + answer, since=since, patience=patience)
            if "refused" not in line:
                return line
            if time.monotonic() > end:
                raise AssertionError("never accepted: " + line)
            time.sleep(0.3)

    def until_ended(self, patience):
        """Follows a trial of one iteration an arm to its end and returns that line.

        As an operator does: each go-ahead is given, a hold under load is continued, and an arm that is pulled is withdrawn.
        """
        end, seen, beat = time.monotonic() + patience, 0, 0
        while time.monotonic() < end and self.process.poll() is None:
            lines = self.lines[seen:]
            seen += len(lines)
            beat += 1
            word = "continue" if beat % 2 else "go-ahead"
            for line in lines:
                if line.startswith("the trial is "):
                    return line
                if "iteration 1 begins" in line:
                    self.type("finish-after-this")
                if "continue: refused" in line and "pause from" in line:
                    word = "withdraw"
            self.type(word)
            time.sleep(1.0)
        raise AssertionError("the trial did not end:\n" + "\n".join(self.lines[-60:]))

    def end(self):
        if self.process.poll() is None:
            self.process.terminate()
            try:
                self.process.wait(10)
            except subprocess.TimeoutExpired:
                self.process.kill()
        return self.process.wait()
