"""Holds the recording of a run against what else is known of the run.

    recording.py example DIR      the bag agrees with itself and with topics.json, all of it can be read, and the
                                  example's odometry is where bodies.csv says the bodies were
    recording.py witness DIR LOG  the same, and its samples are those that bag_witness read and wrote
    recording.py same DIR DIR     two bags have the same rows
    recording.py cut-off DIR      a bag whose run was killed
    recording.py topics DIR TOPIC:TYPE...
                                  the bag agrees with itself and with topics.json, has messages of just these topics, and
                                  all of them can be read by the definitions that it has

DIR is a result folder. Messages are read here by themselves, by OMG's CDR and the definitions in the bag.
"""
import csv
import json
import math
import re
import sqlite3
import struct
import sys

import yaml

# As struct has them; strings are "s".
PLAIN = {"bool": "?", "int8": "b", "uint8": "B", "int16": "h", "uint16": "H", "int32": "i", "uint32": "I", "int64": "q",
         "uint64": "Q", "float32": "f", "float64": "d", "string": "s"}
# Types of the example's own, which a bag cannot define.
WRENCH = ["d"] * 6
BODY_STATE = ["d"] * 13
OWN_FIELDS = {
    "predator_prey_msgs/msg/PlanRequest": ["Q"] + BODY_STATE * 2,
    "predator_prey_msgs/msg/Plan": ["Q", "d", "Q", "?", "d", ["d"] + WRENCH + BODY_STATE],
}
# The numbers of rmw's enumerations.
RMW = {"keep_last": 1, "keep_all": 2, "reliable": 1, "best_effort": 2, "transient_local": 1, "volatile": 2}
FOR_EVER = 2**63 - 1


def check(true, *what):
    if not true:
        sys.exit("FAILED: " + " ".join(str(w) for w in what))


class Cdr:
    """A sample's fields, one after the other; a sequence is its length and then its elements'."""

    def __init__(self, data):
        check(data[:2] == b"\0\1", "not little-endian CDR:", data[:4])
        self.data, self.at = data[4:], 0

    def number(self, kind):
        size = struct.calcsize(kind)
        self.at += -self.at % size
        value, = struct.unpack_from("<" + kind, self.data, self.at)
        self.at += size
        return value

    def text(self):
        size = self.number("I")
        raw = self.data[self.at:self.at + size]
        check(len(raw) == size and raw[-1:] == b"\0", "not a string:", raw)
        self.at += size
        return raw[:-1].decode()

    def fields(self, kinds):
        found = []
        for kind in kinds:
            if isinstance(kind, list):
                found.append(self.number("I"))
                for _ in range(found[-1]):
                    found += self.fields(kind)
            else:
                found.append(self.text() if kind == "s" else self.number(kind))
        return found

    def is_at_end(self):
        return 0 <= len(self.data) - self.at < 4


class Definition:
    """A type as a bag defines it: a message's text, and those of its parts below lines of '='."""

    def __init__(self, kind, text):
        package, _, name = kind.split("/")
        texts = re.split("^" + "=" * 80 + "\nMSG: (.*)\n", text, flags=re.MULTILINE)
        self.texts = dict(zip([f"{package}/{name}", *texts[1::2]], texts[::2]))
        check(len(self.texts) == 1 + len(texts) // 2, kind, "has a part twice")
        self.used = set()
        self.kinds = self.kinds_of(f"{package}/{name}")
        check(self.used == set(self.texts), kind, "defines what it has not", set(self.texts) - self.used)

    def kinds_of(self, name):
        """Of the fields, as Cdr.fields wants them: a list in the list is a sequence."""
        self.used.add(name)
        kinds = []
        for line in self.texts[name].splitlines():
            if not line or "=" in line:
                continue
            field = re.fullmatch(r"([\w/]+)(\[(\d*)\])? (\w+)", line)
            check(field, name, "has the line", repr(line))
            part, has_many, count, _ = field.groups()
            one = [PLAIN[part]] if part in PLAIN else self.kinds_of(part if "/" in part else f"{name.split('/')[0]}/{part}")
            kinds += one * int(count) if count else [one] if has_many else one
        return kinds


class Bag:
    def __init__(self, folder):
        self.file = folder + "/bag/bag_0.db3"
        self.database = sqlite3.connect(f"file:{self.file}?mode=ro", uri=True)
        check(self.rows("PRAGMA integrity_check") == [("ok",)], self.rows("PRAGMA integrity_check"))
        with open(folder + "/bag/metadata.yaml") as file:
            self.text = file.read()
        self.metadata = yaml.safe_load(self.text)["rosbag2_bagfile_information"]
        self.kinds = dict(OWN_FIELDS)
        for kind, encoding, text in self.rows("SELECT topic_type, encoding, encoded_message_definition FROM message_definitions"):
            check(encoding == ("unknown" if kind in OWN_FIELDS else "ros2msg"), kind, "is", encoding)
            if encoding == "ros2msg":
                check(kind not in self.kinds, kind, "is defined twice")
                self.kinds[kind] = Definition(kind, text).kinds
        # Of each topic, in the order of writing: the time stamp, and the message's fields.
        self.samples = {}
        for name, kind, topic in self.rows("SELECT name, type, id FROM topics"):
            self.samples[name] = [(stamp, self.decode(kind, data)) for stamp, data in self.rows(
                f"SELECT timestamp, data FROM messages WHERE topic_id = {topic} ORDER BY id")]

    def rows(self, sql):
        return self.database.execute(sql).fetchall()

    def decode(self, kind, data):
        cdr = Cdr(data)
        fields = cdr.fields(self.kinds[kind])
        check(cdr.is_at_end(), kind, "has", len(cdr.data), "bytes, of which", cdr.at, "are read")
        return fields


def check_span(counted, stamps):
    check(counted["message_count"] == len(stamps), counted, len(stamps))
    check(counted["starting_time"]["nanoseconds_since_epoch"] == min(stamps), counted, min(stamps))
    check(counted["duration"]["nanoseconds"] == max(stamps) - min(stamps), counted, max(stamps))


def ns_of(duration):
    return duration["sec"] * 10**9 + duration["nsec"]


def check_offers(profiles, writers):
    offers = []
    for qos in (writer["qos"] for writer in writers):
        offer = {
            "history": RMW[qos["history"]],
            "depth": qos["depth"] if qos["history"] == "keep_last" else 0,
            "reliability": RMW[qos["reliability"]],
            "durability": RMW[qos["durability"]],
            "deadline": qos["deadline_ns"] or FOR_EVER,
            "lifespan": qos["lifespan_ns"] or FOR_EVER,
            "liveliness": 1,
            "liveliness_lease_duration": qos["lease_ns"] or FOR_EVER,
            "avoid_ros_namespace_conventions": False,
        }
        if offer not in offers:
            offers.append(offer)
    for profile in profiles:
        for key in ("deadline", "lifespan", "liveliness_lease_duration"):
            profile[key] = ns_of(profile[key])
    check(profiles == offers, profiles, "but writers offer", offers)


def read_bag(folder):
    bag = Bag(folder)
    metadata = bag.metadata
    check((metadata["version"], metadata["storage_identifier"]) == (5, "sqlite3"), metadata)
    check(bag.rows("SELECT schema_version, ros_distro FROM schema") == [(4, "iron")], "the schema")
    check(metadata["relative_file_paths"] == ["bag_0.db3"], metadata)
    stamps = [stamp for stamp, in bag.rows("SELECT timestamp FROM messages")]
    check(stamps, "there are no messages")
    check_span(metadata, stamps)
    check(len(metadata["files"]) == 1 and metadata["files"][0]["path"] == "bag_0.db3", metadata)
    check_span(metadata["files"][0], stamps)
    # The database has the same once more, without the key around it.
    (inner,), = bag.rows("SELECT metadata FROM metadata")
    check(yaml.safe_load(inner) == metadata, "the database's metadata differ")

    with open(folder + "/topics.json") as file:
        topics = {topic["topic"]: topic for topic in json.load(file)["topics"]}
    topics.pop("ros_discovery_info", None)  # it is not recorded
    described = {topic["topic_metadata"]["name"]: topic for topic in metadata["topics_with_message_count"]}
    rows = bag.rows("SELECT name, type, serialization_format, offered_qos_profiles FROM topics")
    check(sorted(described) == sorted(name for name, *_ in rows) == sorted(topics), sorted(described), sorted(topics))
    for name, kind, form, profiles in rows:
        here, there, samples = described[name], topics[name], bag.samples[name]
        check(here["topic_metadata"] == {"name": name, "type": kind, "serialization_format": form,
                                         "offered_qos_profiles": profiles}, here)
        check((form, kind) == ("cdr", there["type"]), name, form, kind)
        check(here["message_count"] == len(samples) == there["samples"], name, here, len(samples), there)
        check_offers(yaml.safe_load(profiles), [e for e in there["endpoints"] if e["kind"] == "writer"])
        times = [stamp for stamp, _ in samples]
        check(times == sorted(times), name, "goes back in time")
        if times:
            check(there["last_ns"] - there["first_ns"] == times[-1] - times[0], name, there)
    return bag


def check_steady(samples, start, period_ns, count):
    expected = [start + i * period_ns for i in range(count)]
    check([stamp for stamp, _ in samples] == expected, [stamp for stamp, _ in samples][:4])


def stamp_of(fields):
    return fields[0] * 10**9 + fields[1]


def rotated_back(q, v):
    """v, of the world's frame, in that of a body with the orientation q = x, y, z, w."""
    x, y, z, w = -q[0], -q[1], -q[2], q[3]
    t = [2 * (y * v[2] - z * v[1]), 2 * (z * v[0] - x * v[2]), 2 * (x * v[1] - y * v[0])]
    return [v[0] + w * t[0] + y * t[2] - z * t[1], v[1] + w * t[1] + z * t[0] - x * t[2],
            v[2] + w * t[2] + x * t[1] - y * t[0]]


def example(folder):
    bag = read_bag(folder)
    # Under fixed accounting the virtual CLOCK_REALTIME begins in 2024.
    start, count = 1704067200 * 10**9, 121
    check_steady(bag.samples["/clock"], start, 10**7, count)
    for stamp, fields in bag.samples["/clock"]:
        check(stamp_of(fields) == stamp, "the clock said", fields, "at", stamp)
    bodies = {}
    with open(folder + "/bodies.csv") as file:
        for row in csv.DictReader(file):
            bodies.setdefault(row["body"], []).append([float(v) for k, v in row.items() if k != "body"])
    for body in "predator", "prey":
        samples = bag.samples[f"/{body}/odom"]
        check_steady(samples, start, 10**7, count)
        for (stamp, fields), (time, *state) in zip(samples, bodies[body]):
            check(stamp_of(fields) == stamp and round(time * 1e9) == stamp - start, body, fields[:2], stamp, time)
            check(fields[2:4] == ["world", body], fields[:4])
            check(fields[4:11] == state[:7], body, "at", time, fields[4:11], "but bodies.csv says", state)
            twist = rotated_back(state[3:7], state[7:10]) + rotated_back(state[3:7], state[10:13])
            check(all(math.isclose(a, b, abs_tol=1e-9) for a, b in zip(fields[47:53], twist)), fields[47:53], twist)
            check(not any(fields[11:47]) and not any(fields[53:89]), "covariances")
    # What the programs said to each other: each plan answers a request, and its wrenches were sent.
    requests, plans = bag.samples["/predator/plan_request"], bag.samples["/predator/plan"]
    wrenches = {tuple(fields) for _, fields in bag.samples["/predator/wrench"]}
    check(requests and plans and len(bag.samples["/predator/wrench"]) > 110, "too little was said")
    for stamp, (number, planning_time, *rest) in plans:
        asked = [at for at, fields in requests if fields[0] == number]
        check(len(asked) == 1 and asked[0] + planning_time * 1e9 <= stamp, number, asked, stamp)
    check(len(wrenches) > 10, "all wrenches are the same")


def witness(folder, log):
    bag = read_bag(folder)
    with open(log) as file:
        said = [json.loads(line) for line in file]
    latencies = {"/odom": 5 * 10**6, "/clock": 0, "/joints": 0}
    for topic, latency in latencies.items():
        read = [(line["at"] + latency, line["fields"]) for line in said if line.get("read") == "rt" + topic]
        check(len(read) > 80, topic, "was read", len(read), "times")
        recorded = [s for s in bag.samples[topic] if read[0][0] <= s[0] <= read[-1][0]]
        check(recorded == read, topic, recorded[:1], read[:1])
        for stamp, fields in bag.samples[topic]:
            check(stamp_of(fields) == stamp - latency, topic, fields[:2], stamp)
    for topic in "/wrench", "/route", "/twist":
        written = [line for line in said if line.get("written") == "rt" + topic]
        recorded = bag.samples[topic]
        check(len(written) == 90, topic, "was written", len(written), "times")
        check([fields for _, fields in recorded] == [line["fields"] for line in written], topic, recorded[:1])
        for (stamp, _), line in zip(recorded, written):
            check(line["before"] <= stamp <= line["after"], topic, line, "recorded at", stamp)


def same(one, other):
    dumps = [list(Bag(folder).database.iterdump()) for folder in (one, other)]
    check(len(dumps[0]) > 400 and dumps[0] == dumps[1], "the bags differ:",
          [pair for pair in zip(*dumps) if pair[0] != pair[1]][:1])
    check(Bag(one).text == Bag(other).text, "metadata.yaml differs")


def cut_off(folder):
    bag = Bag(folder)
    count = sum(len(samples) for samples in bag.samples.values())
    # A batch may be in the database and not yet counted.
    check(0 < bag.metadata["message_count"] <= count, bag.metadata["message_count"], count)


def topics(folder, *meant):
    bag = read_bag(folder)
    found = {f"{name}:{kind}" for name, kind in bag.rows("SELECT name, type FROM topics") if bag.samples[name]}
    check(found == set(meant), "the bag has", sorted(found), "and not", sorted(meant))


if __name__ == "__main__":
    {"example": example, "witness": witness, "same": same, "cut-off": cut_off,
     "topics": topics}[sys.argv[1]](*sys.argv[2:])
