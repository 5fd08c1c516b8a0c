"""A run that goes on with a page, for tests: started, asked and told over HTTP."""
import http.client
import json
import os
import re
import subprocess
import time

PATIENCE = 180  # s of real time: so long no wait of a test takes, however busy the host is, a processor's of others included


def full_pipe():
    """Its ends: whoever writes into it waits until somebody reads."""
    read_end, write_end = os.pipe()
    os.set_blocking(write_end, False)
    try:
        while True:
            os.write(write_end, bytes(4096))
    except BlockingIOError:
        os.set_blocking(write_end, True)
    return read_end, write_end


class LiveRun:
    def __init__(self, tcsim, scenario, out, *options, accounting="fixed", held=False):
        """`held`: it is not through before `release`, for it cannot print its summary. A run that has ended gives those
        who watch it a second to see that; a test is not to depend on who is that fast."""
        self.out = out
        self.said = open(f"{out}.said", "w+")
        self.full, stdout = full_pipe() if held else (None, self.said)
        self.process = subprocess.Popen([tcsim, "run", scenario, "--accounting", accounting, "--out", out, "--view", *options],
                                        stdout=stdout, stderr=self.said, stdin=subprocess.DEVNULL)
        if held:
            os.close(stdout)
        self.url = self.until(self.find_url)
        found = re.fullmatch(r"http://127\.0\.0\.1:(\d+)/([0-9a-f]{32})/", self.url)
        assert found, self.url
        self.port, self.token = int(found[1]), found[2]

    def words(self):
        with open(f"{self.out}.said") as file:
            return file.read()

    def find_url(self):
        assert self.process.poll() is None, self.words()
        found = re.search(r"watch the run at (\S+/)", self.words())
        return found and found[1]

    def until(self, condition):
        """What it is once it is something."""
        deadline = time.monotonic() + PATIENCE
        while not (value := condition()):
            assert time.monotonic() < deadline, ("waited in vain", self.process.poll(), self.words())
            time.sleep(0.02)
        return value

    def ask(self, rest="", body=None, **changed):
        """The status and the body of the answer. `changed`: other headers, method or path than usual."""
        connection = http.client.HTTPConnection("127.0.0.1", self.port, timeout=PATIENCE)
        headers = {"Host": f"127.0.0.1:{self.port}", **changed.get("headers", {})}
        connection.putrequest(changed.get("method", "GET" if body is None else "POST"),
                              changed.get("path", f"/{self.token}/{rest}"), skip_host=True, skip_accept_encoding=True)
        for name, value in headers.items():
            for one in value if isinstance(value, list) else [value]:
                connection.putheader(name, one)
        if body is not None:
            connection.putheader("Content-Length", str(len(body)))
        connection.endheaders(body)
        answer = connection.getresponse()
        content = answer.read()
        connection.close()
        return answer.status, content

    def news(self):
        status, content = self.ask("news")
        assert status == 200, status
        return json.loads(content)

    def status(self):
        return self.news()["status"]

    def control(self, words):
        """Returns once the run has taken it. Not for what may let it go to its end: nobody would say so any more."""
        status, content = self.ask("control", words.encode())
        assert status == 200, (words, status)
        asked = json.loads(content)["asked"]
        return self.until(lambda: (now := self.status())["taken"] >= asked and now)

    def stands_at(self, ns):
        return self.until(lambda: (now := self.status())["stage"] == "stands" and now["now"] == ns)

    def tell(self, words):
        """For what may let it go to its end, with which its server goes: the answer may not come."""
        try:
            status, _ = self.ask("control", words.encode())
            assert status in (200, 409), (words, status)  # 409: it has ended
        except (OSError, http.client.HTTPException):
            pass

    def release(self):
        with open(self.full, "rb") as pipe:
            self.full = None
            pipe.read()

    def end(self, status=0):
        assert self.process.wait(PATIENCE) == status, (self.process.returncode, self.words())
        return self.words()

    def __enter__(self):
        return self

    def __exit__(self, *_):
        if self.process.poll() is None:
            self.process.terminate()
        if self.full is not None:
            self.release()
        self.process.wait()
        self.said.close()
