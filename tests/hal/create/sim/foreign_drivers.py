#!/usr/bin/env python3
"""Drives `startrack create-sim` as other people's drivers do, with nothing of startrack's own: foreign_drivers.py STARTRACK

One driver polls (142, as pycreate2 does), one streams and drives by radius (148 and 137, as libcreate does), one is for the
Create 1 (57600 baud, 149, distance and angle that clear on reading). Each drives a circle and reads its sensors.
"""
import json
import math
import os
import select
import struct
import subprocess
import sys
import termios
import threading
import time


class Port:
    def __init__(self, path, speed):
        self.fd = os.open(path, os.O_RDWR | os.O_NOCTTY)
        mode = termios.tcgetattr(self.fd)
        mode[0], mode[1], mode[3] = 0, 0, 0
        mode[2] = termios.CS8 | termios.CREAD | termios.CLOCAL
        mode[4] = mode[5] = speed
        termios.tcsetattr(self.fd, termios.TCSANOW, mode)

    def say(self, *values, shape=None):
        os.write(self.fd, struct.pack(shape or "%dB" % len(values), *values))

    def hear(self, count, timeout=1.0):
        data, end = b"", time.monotonic() + timeout
        while len(data) < count and time.monotonic() < end:
            if select.select([self.fd], [], [], 0.05)[0]:
                data += os.read(self.fd, count - len(data))
        return data

    def close(self):
        os.close(self.fd)


class Robot:
    """The simulated robot as a process; its true state comes as JSON lines."""

    def __init__(self, program, *options):
        self.process = subprocess.Popen([program, "create-sim", "--quiet", "--json", "50", *options],
                                        stdout=subprocess.PIPE, text=True)
        self.path = self.process.stdout.readline().strip()
        self.states = []
        self.reader = threading.Thread(target=self.read)
        self.reader.start()

    def read(self):
        for line in self.process.stdout:
            self.states.append(json.loads(line))

    def end(self):
        time.sleep(0.1)
        self.process.terminate()
        self.reader.join()
        self.process.wait()
        return self.states


def check(what, holds):
    print(("ok      " if holds else "FAILED  ") + what)
    return holds


def polling(program):
    robot = Robot(program)
    port = Port(robot.path, termios.B115200)
    port.say(128)
    time.sleep(0.2)
    port.say(131)
    time.sleep(0.2)
    counts, bytes_read = [], 0
    for i in range(60):  # pycreate2: drive_direct(100, 200), then get_sensors()
        port.say(145, 200, 100, shape=">Bhh")
        port.say(142, 100)
        reply = port.hear(80)
        bytes_read += len(reply)
        if len(reply) == 80:
            counts.append(struct.unpack(">HH", reply[52:56]) + struct.unpack(">HB", reply[15:18]))
            mode = reply[40]
        time.sleep(0.02)
    port.say(145, 0, 0, shape=">Bhh")
    time.sleep(0.3)
    port.say(173)
    port.close()
    last = robot.end()[-1]
    left = (counts[-1][0] - counts[0][0]) % 65536 * math.pi * 72 / 508.8
    right = (counts[-1][1] - counts[0][1]) % 65536 * math.pi * 72 / 508.8
    return (check("142: every reply is whole", bytes_read == 60 * 80)
            & check("142: Safe mode is told", mode == 2)
            & check("145: the right wheel rolls twice as far as the left", 1.9 < right / left < 2.1)
            & check("173: Off", last["mode"] == "off" and last["left"] == 0))


def streaming(program):
    robot = Robot(program)
    port = Port(robot.path, termios.B115200)
    port.say(128, 131)
    time.sleep(0.2)
    port.say(148, 4, 7, 35, 43, 44)  # libcreate: a stream of singles, checked by its sum
    port.say(137, 200, 500, shape=">Bhh")  # 0.2 m/s on 0.5 m: a circle in 15.7 s
    buffer, frames, bad, end = b"", 0, 0, time.monotonic() + 17.2
    while time.monotonic() < end:
        buffer += port.hear(14, 0.1)
        while len(buffer) >= 14:
            if buffer[0] == 19 and buffer[1] == 10 and sum(buffer[:13]) % 256 == 0:
                frames, buffer = frames + 1, buffer[13:]
            else:
                bad, buffer = bad + 1, buffer[1:]
    port.say(137, 0, -32768, shape=">Bhh")
    time.sleep(0.3)
    port.close()
    states = robot.end()
    radii = [s["v"] / s["w"] for s in states if s["v"] > 0.1999]  # once its wheels have their speeds
    return (check("148: a frame every 15 ms (%d, %d bytes bad)" % (frames, bad), frames > 1000 and bad < 14)
            & check("137: a whole circle of radius 0.5 m (%.1f rad, %.4f to %.4f m)" %
                    (states[-1]["yaw"], min(radii), max(radii)), states[-1]["yaw"] > 2 * math.pi
                    and all(abs(r - 0.5) < 0.002 for r in radii)))


def create1(program):
    robot = Robot(program, "--model", "create1")
    port = Port(robot.path, termios.B57600)
    port.say(128, 132)
    time.sleep(0.2)
    port.say(140, 0, 2, 62, 8, 66, 8)
    port.say(141, 0)
    port.say(149, 2, 19, 20)
    port.hear(4)
    way = angle = 0
    for i in range(8):
        port.say(137, 200, 500, shape=">Bhh")
        time.sleep(0.25)
        port.say(149, 2, 19, 20)
        d, a = struct.unpack(">hh", port.hear(4))
        way, angle = way + d, angle + a
    port.say(149, 2, 37, 35)
    playing, mode = port.hear(2)
    port.say(137, 0, 0, shape=">Bhh")
    time.sleep(0.3)
    port.say(149, 2, 19, 20)
    d, a = struct.unpack(">hh", port.hear(4))
    way, angle = way + d, angle + a
    port.close()
    last = robot.end()[-1]
    return (check("149: distance adds up to the way", abs(way - 500 * last["yaw"]) < 12)
            & check("149: angle adds up to the turn", abs(angle - math.degrees(last["yaw"])) < 2.5)
            & check("132: Full, and the song is over", mode == 3 and playing == 0))


if __name__ == "__main__":
    results = [run(sys.argv[1]) for run in (polling, streaming, create1)]
    sys.exit(0 if all(results) else 1)
