"""A run that goes on with a page, for tests: started, asked and told over HTTP."""
import http.client
import json
import re
import subprocess
import time


class LiveRun:
    def __init__(self, tcsim, scenario, out, *options, accounting="fixed"):
        self.out = out
        self.said = open(f"{out}.said", "w+")
        self.process = subprocess.Popen([tcsim, "run", scenario, "--accounting", accounting, "--out", out, "--view", *options],
                                        stdout=self.said, stderr=subprocess.STDOUT, stdin=subprocess.DEVNULL)
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
        """What it is once it is something. The test's own time limit ends a wait in vain."""
        while not (value := condition()):
            time.sleep(0.02)
        return value

    def ask(self, rest="", body=None, **changed):
        """The status and the body of the answer. `changed`: other headers, method or path than usual."""
        connection = http.client.HTTPConnection("127.0.0.1", self.port, timeout=20)
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

    def wish(self, words):
        """Returns once the run has taken it."""
        status, content = self.ask("wish", words.encode())
        assert status == 200, (words, status)
        asked = json.loads(content)["asked"]
        return self.until(lambda: (now := self.status())["taken"] >= asked and now)

    def stands_at(self, ns):
        return self.until(lambda: (now := self.status())["stage"] == "stands" and now["now"] == ns)

    def end(self, status=0):
        assert self.process.wait() == status, (self.process.returncode, self.words())
        return self.words()

    def __enter__(self):
        return self

    def __exit__(self, *_):
        if self.process.poll() is None:
            self.process.terminate()
            self.process.wait()
        self.said.close()
