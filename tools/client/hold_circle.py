#!/usr/bin/env python3
"""Holds a circle of half a metre to the left of where the robot starts: hold_circle.py [PORT] [TURNS]"""
import math
import sys

from startrack_client import Tracker

RADIUS, SPEED = 0.5, 0.2
with Tracker(port=int(sys.argv[1]) if len(sys.argv) > 1 else 7171) as tracker:
    left, before, centre = 2 * math.pi * float(sys.argv[2] if len(sys.argv) > 2 else 1), None, None
    for frame in tracker.frames():
        robot = frame["robot"]
        if left <= 0:
            break
        if robot["state"] != "driving":
            continue
        x, y, yaw = robot["x"], robot["y"], robot["yaw"]
        centre = centre or (x - RADIUS * math.sin(yaw), y + RADIUS * math.cos(yaw))
        bearing = math.atan2(y - centre[1], x - centre[0])
        outside = math.hypot(x - centre[0], y - centre[1]) - RADIUS
        aside = math.remainder(bearing + math.pi / 2 - yaw, 2 * math.pi)
        tracker.drive(SPEED, SPEED / RADIUS + 8 * SPEED * outside + 2 * aside)
        left -= math.remainder(bearing - before, 2 * math.pi) if before is not None else 0
        before = bearing
