"""Poses from, and drive commands to, `startrack run --serve PORT`. Standard library only.

    from startrack_client import Tracker
    with Tracker(port=7171) as tracker:
        for frame in tracker.frames():
            print(frame["t"], frame["robot"]["x"], frame["robot"]["y"], frame["robot"]["yaw"])

A frame is a dictionary: `t` (seconds), `frame`, `latency_ms` (from the complete image until published),
`robot` (state, held_by, object, seen; x, y, yaw of its base now, and frame_x, frame_y, frame_yaw when the
image was taken; told_v, told_w) and `objects`, each with id, state and, while it has a pose, x, y, z, roll,
pitch, yaw, vx, vy, v, w, yaw_source and covariance (upper triangle, camera axes). Metres, radians, floor frame.

The robot stands when this program ends, and when it says nothing for half a second.
"""
import json
import socket


class Tracker:
    def __init__(self, host="127.0.0.1", port=7171, timeout_s=10.0):
        self._socket = socket.create_connection((host, port), timeout=timeout_s)
        self._socket.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
        self._rest = b""

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.close()

    def close(self):
        """Ends the connection; the robot stops."""
        self._socket.close()

    def drive(self, v, w):
        """Forward speed in m/s and turn rate in rad/s, left positive. Say it at least every half second."""
        self._send("drive %.4f %.4f\n" % (v, w))

    def stop(self):
        self._send("stop\n")

    def frames(self):
        """Every frame as it comes, until the run ends. ValueError for a command that was refused."""
        while True:
            frame = self._next()
            if frame is None:
                return
            if "error" in frame:
                raise ValueError(frame["error"])
            yield frame

    def newest(self):
        """Waits for a frame and skips those that are older; None when the run has ended."""
        frame = self._next()
        while frame is not None and b"\n" in self._rest:
            frame = self._next()
        return frame

    def _send(self, line):
        self._socket.sendall(line.encode("ascii"))

    def _next(self):
        while b"\n" not in self._rest:
            data = self._socket.recv(65536)
            if not data:
                return None
            self._rest += data
        line, self._rest = self._rest.split(b"\n", 1)
        return json.loads(line)
