# SPDX-License-Identifier: Apache-2.0
"""Starts `pellucid view`, and speaks HTTP and WebSocket with it. Standard library only."""

import base64
import json
import os
import signal
import socket
import struct
import subprocess
import sys
import urllib.parse

PROGRAM = os.environ.get("PELLUCID_PROGRAM", "pellucid")
SECONDS = 120  # until a program that hangs is killed


class Viewer:
    """The program, until the end of a with statement."""

    def __init__(self, *arguments, folder=None):
        # The outer time-out ends the program even where this process is killed.
        self.process = subprocess.Popen(
            ["timeout", "-k", "5", str(4 * SECONDS), PROGRAM, "view", "--no-open", *arguments],
            stdout=subprocess.PIPE, stderr=subprocess.PIPE, cwd=folder, start_new_session=True)
        self.address = self.process.stdout.readline().decode().strip()
        if not self.address:
            raise RuntimeError(self.process.communicate()[1].decode())
        url = urllib.parse.urlsplit(self.address)
        self.host, self.port, self.path = url.netloc, url.port, url.path

    def __enter__(self):
        return self

    def __exit__(self, *unused):
        self.stop()

    def stop(self, number=signal.SIGINT):
        """Ends the program as Ctrl-C does, and gives its exit status and what stderr had."""
        if self.process.poll() is None:
            os.kill(self.program(), number)
        try:
            errors = self.process.communicate(timeout=SECONDS)[1].decode()
        except subprocess.TimeoutExpired:
            os.killpg(self.process.pid, signal.SIGKILL)
            raise
        return self.process.returncode, errors

    def program(self):
        """The process of the program, which is the child of its time-out."""
        pid = self.process.pid
        with open(f"/proc/{pid}/task/{pid}/children", encoding="ascii") as file:
            return int(file.read().split()[0])

    def connect(self):
        connection = socket.create_connection(("127.0.0.1", self.port), timeout=SECONDS)
        return connection

    def request(self, path, headers=None, method="GET"):
        """The status, headers and body of an answer; status 0: the connection was closed."""
        lines = {"Host": self.host, "Connection": "close", **(headers or {})}
        text = f"{method} {path} HTTP/1.1\r\n"
        text += "".join(f"{key}: {value}\r\n" for key, value in lines.items() if value is not None)
        with self.connect() as connection:
            connection.sendall((text + "\r\n").encode("latin-1"))
            return read_answer(connection)

    def upload(self, path, body, headers=None, length=None):
        """The status and text of the answer to a file that is put at upload/PATH."""
        lines = {"Host": self.host, "Origin": "http://" + self.host,
                 "Content-Length": str(len(body) if length is None else length),
                 **(headers or {})}
        text = f"PUT {self.path}upload/{path} HTTP/1.1\r\n"
        text += "".join(f"{key}: {value}\r\n" for key, value in lines.items() if value is not None)
        with self.connect() as connection:
            connection.sendall((text + "\r\n").encode("latin-1") + body)
            status, _, answer = read_answer(connection)
            return status, answer.decode()

    def open_socket(self, path=None, **headers):
        return WebSocket(self, self.path + "socket" if path is None else path, headers)


def read_answer(connection):
    data = b""
    try:
        while True:
            part = connection.recv(65536)
            if not part:
                break
            data += part
    except ConnectionError:
        pass
    head, _, body = data.partition(b"\r\n\r\n")
    lines = head.decode("latin-1").split("\r\n")
    if not lines[0]:
        return 0, {}, b""
    headers = dict(line.split(": ", 1) for line in lines[1:])
    return int(lines[0].split()[1]), {key.lower(): value for key, value in headers.items()}, body


class Refused(Exception):
    """A handshake that was answered with another status than 101."""

    def __init__(self, status, body):
        super().__init__(str(status))
        self.status, self.body = status, body


class WebSocket:
    """A client as RFC 6455 describes it, as far as the tests need one."""

    def __init__(self, viewer, path, headers):
        self.connection = viewer.connect()
        lines = {"Host": viewer.host, "Origin": "http://" + viewer.host, "Upgrade": "websocket",
                 "Connection": "Upgrade", "Sec-WebSocket-Version": "13",
                 "Sec-WebSocket-Key": base64.b64encode(os.urandom(16)).decode(), **headers}
        text = f"GET {path} HTTP/1.1\r\n"
        text += "".join(f"{key}: {value}\r\n" for key, value in lines.items() if value is not None)
        self.connection.sendall((text + "\r\n").encode("latin-1"))
        self.buffer = b""
        while b"\r\n\r\n" not in self.buffer:
            part = self.connection.recv(65536)
            if not part:
                break
            self.buffer += part
        head, _, self.buffer = self.buffer.partition(b"\r\n\r\n")
        status = int(head.split()[1]) if head else 0
        if status != 101:
            self.connection.close()
            raise Refused(status, self.buffer)

    def __enter__(self):
        return self

    def __exit__(self, *unused):
        self.connection.close()

    def send_bytes(self, payload, opcode=1):
        head = bytes([0x80 | opcode])
        if len(payload) < 126:
            head += bytes([0x80 | len(payload)])
        elif len(payload) < 65536:
            head += b"\xfe" + struct.pack(">H", len(payload))
        else:
            head += b"\xff" + struct.pack(">Q", len(payload))
        mask = os.urandom(4)
        keys = mask * (len(payload) // 4 + 1)
        masked = (int.from_bytes(payload, sys.byteorder) ^
                  int.from_bytes(keys[:len(payload)], sys.byteorder)).to_bytes(
                      len(payload), sys.byteorder)
        self.connection.sendall(head + mask + masked)

    def send(self, **message):
        self.send_bytes(json.dumps(message).encode())

    def _take(self, count):
        while len(self.buffer) < count:
            part = self.connection.recv(1 << 20)
            if not part:
                raise ConnectionError("the server closed the connection")
            self.buffer += part
        taken, self.buffer = self.buffer[:count], self.buffer[count:]
        return taken

    def receive(self):
        """The next message: a dictionary, with "bytes" behind the header of a binary one."""
        while True:
            first, second = self._take(2)
            length = second & 127
            if length == 126:
                length = struct.unpack(">H", self._take(2))[0]
            elif length == 127:
                length = struct.unpack(">Q", self._take(8))[0]
            payload = self._take(length)
            opcode = first & 15
            if opcode == 8:
                raise ConnectionError("the server closed the WebSocket")
            if opcode == 9:
                self.send_bytes(payload, 10)
            if opcode == 1:
                return json.loads(payload)
            if opcode == 2:
                size = struct.unpack("<I", payload[:4])[0]
                return {**json.loads(payload[4:4 + size]), "bytes": payload[4 + size:]}

    def receive_until(self, wanted):
        """The next message for which wanted(message) is true."""
        while True:
            message = self.receive()
            if wanted(message):
                return message

    def receive_type(self, name):
        return self.receive_until(lambda message: message["type"] == name)

    def exact_frame(self):
        return self.receive_until(lambda message: message["type"] == "frame" and
                                  message["state"] == "exact")
