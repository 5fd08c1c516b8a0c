"""NATS: a server beside the receiver, and clients that speak its protocol, which is lines of text. As main.cc is called."""

import re
import socket
import subprocess
import sys
import time

role, where, count = sys.argv[1], sys.argv[2], int(sys.argv[3])
host, port = re.fullmatch(r"tcp://(.*):(\d+)", where).groups()


class Client:
    def __init__(self, host):
        deadline = time.monotonic() + 10
        while True:
            try:
                self.socket = socket.create_connection((host, int(port)))
                break
            except ConnectionRefusedError:
                assert time.monotonic() < deadline
                time.sleep(0.01)
        self.lines = self.socket.makefile("rb")
        assert self.lines.readline().startswith(b"INFO ")
        self.say(b'CONNECT {"verbose":false}\r\nPING\r\n')
        assert self.lines.readline() == b"PONG\r\n"

    def say(self, text):
        self.socket.sendall(text)

    def message(self):
        while not (line := self.lines.readline()).startswith(b"MSG "):
            assert line == b"PING\r\n", line
            self.say(b"PONG\r\n")
        return self.lines.read(int(line.split()[-1]) + 2)[:-2]


def send():
    time.sleep(0.5)
    client = Client(host)
    time.sleep(0.5)
    for number in range(count):
        text = b"%d %d" % (number, time.time_ns())
        client.say(b"PUB numbers %d\r\n%s\r\n" % (len(text), text))
        time.sleep(0.01)
    time.sleep(0.5)


def receive():
    server = subprocess.Popen(["nats-server", "-a", host, "-p", port], stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    try:
        client = Client("127.0.0.1")
        client.say(b"SUB numbers 1\r\n")
        for _ in range(count):
            number, sent_ns = client.message().split()
            print(int(number), time.time_ns() - int(sent_ns), flush=True)
    finally:
        server.terminate()
        server.wait()


send() if role == "send" else receive()
