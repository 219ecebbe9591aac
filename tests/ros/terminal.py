#!/usr/bin/env python3
"""Runs a command in a terminal of its own, as `xterm -e` does, where there is no screen: a launch prefix for tests."""
import fcntl
import os
import pty
import signal
import struct
import sys
import termios

child, terminal = pty.fork()
if child == 0:
    os.execvp(sys.argv[1], sys.argv[1:])
fcntl.ioctl(terminal, termios.TIOCSWINSZ, struct.pack("HHHH", 40, 120, 0, 0))
for number in (signal.SIGINT, signal.SIGTERM):
    signal.signal(number, lambda number, _frame: os.kill(child, number))
try:
    while os.read(terminal, 65536):
        pass
except OSError:
    # The other side has been closed: the command has ended.
    pass
sys.exit(os.waitstatus_to_exitcode(os.waitpid(child, 0)[1]))
