"""Holds the recording of a run against what else is known of the run.

    recording.py example DIR      the bag agrees with itself and with topics.json, all of it can be read, and the
                                  example's odometry is where bodies.csv says the bodies were
    recording.py witness DIR LOG  the same, and its samples are those that bag_witness read and wrote
    recording.py same DIR DIR     two bags have the same rows
    recording.py cut-off DIR      a bag whose run was killed
    recording.py topics DIR TOPIC:TYPE...
                                  the bag agrees with itself and with topics.json, has messages of just these topics, and
                                  all of them can be read by the definitions that it has

    recording.py world DIR        where it says that bodies and links are agrees with bodies.csv, what went over channels of
                                  JSON with bodies.csv and commands.csv
    recording.py alike DIR DIR    two bags in different storages have the same messages

DIR is a result folder. Of a bag in SQLite messages are read here by themselves, by OMG's CDR and the definitions in the
bag; one in MCAP is read by Foxglove's reader, installed in $MCAP_READER (tests/mcap).
"""
import base64
import csv
import json
import math
import re
import os
import sqlite3
import struct
import subprocess
import sys
import zlib

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


def decode(kind, fields, data):
    cdr = Cdr(data)
    found = cdr.fields(fields)
    check(cdr.is_at_end(), kind, "has", len(cdr.data), "bytes, of which", cdr.at, "are read")
    return found


def read_metadata(folder):
    with open(folder + "/bag/metadata.yaml") as file:
        text = file.read()
    return text, yaml.safe_load(text)["rosbag2_bagfile_information"]


class SqliteBag:
    """A bag in SQLite. `topics`: name, type, serialization and the writers' QoS of each; `samples`: of each topic by
    name, in the order of writing, time stamps and messages' fields."""
    storage, file_name = "sqlite3", "bag_0.db3"

    def __init__(self, folder):
        self.file = folder + "/bag/bag_0.db3"
        self.database = sqlite3.connect(f"file:{self.file}?mode=ro", uri=True)
        check(self.rows("PRAGMA integrity_check") == [("ok",)], self.rows("PRAGMA integrity_check"))
        self.text, self.metadata = read_metadata(folder)
        self.kinds = dict(OWN_FIELDS)
        for kind, encoding, text in self.rows("SELECT topic_type, encoding, encoded_message_definition FROM message_definitions"):
            check(encoding == ("unknown" if kind in OWN_FIELDS else "ros2msg"), kind, "is", encoding)
            if encoding == "ros2msg":
                check(kind not in self.kinds, kind, "is defined twice")
                self.kinds[kind] = Definition(kind, text).kinds
        self.topics = self.rows("SELECT name, type, serialization_format, offered_qos_profiles FROM topics")
        self.samples = {}
        for name, kind, topic in self.rows("SELECT name, type, id FROM topics"):
            self.samples[name] = [(stamp, decode(kind, self.kinds[kind], data)) for stamp, data in self.rows(
                f"SELECT timestamp, data FROM messages WHERE topic_id = {topic} ORDER BY id")]

    def rows(self, sql):
        return self.database.execute(sql).fetchall()

    def dump(self):
        return list(self.database.iterdump())

    def check_file(self):
        check(self.rows("SELECT schema_version, ros_distro FROM schema") == [(4, "iron")], "the schema")
        # The database has the metadata once more, without the key around them.
        (inner,), = self.rows("SELECT metadata FROM metadata")
        check(yaml.safe_load(inner) == self.metadata, "the database's metadata differ")


def from_json(value):
    """What JSON has no number for is {"number": TEXT}."""
    if isinstance(value, dict):
        return float(value["number"]) if "N" in value["number"] or "I" in value["number"] else int(value["number"])
    return [from_json(v) for v in value] if isinstance(value, list) else value


class McapBag:
    """The same of one in MCAP."""
    storage, file_name = "mcap", "bag_0.mcap"

    def __init__(self, folder, is_cut_off=False):
        self.file = folder + "/bag/bag_0.mcap"
        self.text, self.metadata = read_metadata(folder)
        self.topics, self.samples, kinds = [], {}, {}
        command = ["node", os.environ["MCAP_READER"] + "/read.mjs", self.file] + ["cut-off"] * is_cut_off
        reader = subprocess.run(command, capture_output=True, text=True)
        check(reader.returncode == 0, "the reader of MCAP files says:", reader.stderr.strip())
        for line in map(json.loads, reader.stdout.splitlines()):
            if "topic" in line:
                name = line["topic"]
                self.topics.append((name, line["type"], line["encoding"], line["profiles"]))
                check((line["definition"] == "") == (line["type"] in OWN_FIELDS), line["type"], "is defined wrongly")
                kinds[name], self.samples[name] = line["type"], []
            elif "of" in line:
                name = line["of"]
                fields = from_json(line["fields"]) if "fields" in line else decode(
                    kinds[name], OWN_FIELDS[kinds[name]], base64.b64decode(line["cdr"]))
                self.samples[name].append((from_json(line["stamp"]), fields))
            else:
                self.end = line

    def dump(self):
        with open(self.file, "rb") as file:
            return list(file.read())

    def check_file(self):
        check(self.end["profile"] == "ros2", self.end)
        check(self.end["chunks"] > 1, "it is one chunk")
        # The checksum of the data, which Foxglove's reader only reports.
        with open(self.file, "rb") as file:
            data = file.read()
        summary, = struct.unpack_from("<Q", data, len(data) - 8 - 20)  # in the footer, before the magic
        check(zlib.crc32(data[:summary - 13]) == self.end["crc"], "the data's checksum is wrong")


def Bag(folder, **how):
    return (McapBag if os.path.exists(folder + "/bag/bag_0.mcap") else SqliteBag)(folder, **how)



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


def is_own(name):
    """Of the run's own topics, which no program has."""
    return name.startswith(("/bodies/", "/channels/", "/world/")) or name == "/tf"


def is_of_world(name, sample):
    """Among a robot's transforms may be the world's."""
    return name == "/tf" and sample[1][3:4] == ["world"]


def read_bag(folder):
    bag = Bag(folder)
    metadata = bag.metadata
    check((metadata["version"], metadata["storage_identifier"]) == (5, bag.storage), metadata)
    check(metadata["relative_file_paths"] == [bag.file_name], metadata)
    bag.check_file()
    stamps = [stamp for samples in bag.samples.values() for stamp, _ in samples]
    check(stamps, "there are no messages")
    check_span(metadata, stamps)
    check(len(metadata["files"]) == 1 and metadata["files"][0]["path"] == bag.file_name, metadata)
    check_span(metadata["files"][0], stamps)

    with open(folder + "/topics.json") as file:
        topics = {topic["topic"]: topic for topic in json.load(file)["topics"]}
    topics.pop("ros_discovery_info", None)  # it is not recorded
    described = {topic["topic_metadata"]["name"]: topic for topic in metadata["topics_with_message_count"]}
    check(sorted(described) == sorted(name for name, *_ in bag.topics), sorted(described), bag.topics)
    of_programs = [name for name in described if name in topics or not is_own(name)]
    check(sorted(of_programs) == sorted(topics), sorted(described), sorted(topics))
    for name, kind, form, profiles in bag.topics:
        if name not in topics:
            check(described[name]["message_count"] == len(bag.samples[name]), name, described[name])
            continue
        here, there, samples = described[name], topics[name], [s for s in bag.samples[name] if not is_of_world(name, s)]
        check(here["message_count"] == len(bag.samples[name]), name, here)
        check(here["topic_metadata"] == {"name": name, "type": kind, "serialization_format": form,
                                         "offered_qos_profiles": profiles}, here)
        check((form, kind) == ("cdr", there["type"]), name, form, kind)
        check(len(samples) == there["samples"], name, here, len(samples), there)
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
    dumps = [Bag(folder).dump() for folder in (one, other)]
    check(len(dumps[0]) > 400 and dumps[0] == dumps[1], "the bags differ:",
          [pair for pair in zip(*dumps) if pair[0] != pair[1]][:1])
    check(Bag(one).text == Bag(other).text, "metadata.yaml differs")


def cut_off(folder):
    bag = Bag(folder, **({"is_cut_off": True} if os.path.exists(folder + "/bag/bag_0.mcap") else {}))
    count = sum(len(samples) for samples in bag.samples.values())
    # A batch may be in the database and not yet counted.
    check(0 < bag.metadata["message_count"] <= count, bag.metadata["message_count"], count)


def alike(one, other):
    bags = [Bag(folder) for folder in (one, other)]
    check([bag.storage for bag in bags] == ["sqlite3", "mcap"], "the storages")
    check([t[:3] for t in bags[0].topics] == [t[:3] for t in bags[1].topics], bags[0].topics, bags[1].topics)
    for name, kind, *_ in bags[0].topics:
        pairs = list(zip(*(bag.samples[name] for bag in bags)))
        check(len(pairs) == len(bags[0].samples[name]) == len(bags[1].samples[name]), name, "has other messages")
        for (stamp, fields), (other_stamp, other_fields) in pairs:
            # What is not a number is not equal to itself.
            equal = [a == b or a != a and b != b for a, b in zip(fields, other_fields)]
            check(stamp == other_stamp and len(fields) == len(other_fields) and all(equal), name, fields, other_fields)


def rows_of(path):
    with open(path) as file:
        return list(csv.DictReader(file))


def world(folder):
    bag = read_bag(folder)
    start = 1704067200 * 10**9
    poses = {}
    for row in rows_of(folder + "/bodies.csv"):
        poses.setdefault(row["body"], {})[round(float(row["time_s"]) * 1e9)] = [float(v) for v in list(row.values())[2:]]

    def check_state(what, fields, sampled):
        stamp, body = stamp_of(fields), fields[3]
        check(fields[2] == "world" and stamp - start == sampled, what, fields[:4], sampled)
        state = poses[body][sampled]
        check(fields[4:11] == state[:7], what, "at", sampled, fields[4:11], "but bodies.csv says", state)
        twist = rotated_back(state[3:7], state[7:10]) + rotated_back(state[3:7], state[10:13])
        check(all(math.isclose(a, b, abs_tol=1e-9) for a, b in zip(fields[47:53], twist)), what, fields[47:53], twist)

    bodies = [name for name in bag.samples if name.startswith("/bodies/")]
    check(bodies, "there are no bodies")
    for name in bodies:
        samples = bag.samples[name]
        check([stamp - start for stamp, _ in samples] == list(poses[samples[0][1][3]]), name, "has other times")
        for stamp, fields in samples:
            check_state(name, fields, stamp - start)
    transforms = [s for s in bag.samples["/tf"] if is_of_world("/tf", s)]
    check([stamp - start for stamp, _ in transforms] == list(next(iter(poses.values()))), "/tf has other times")
    for stamp, fields in transforms:
        check(fields[0] == len(poses), fields[0], "transforms of", len(poses))
        for at in range(1, len(fields), 11):
            (sec, nanosec, frame, body), pose = fields[at:at + 4], fields[at + 4:at + 11]
            check(sec * 10**9 + nanosec == stamp and frame == "world", fields[at:at + 4])
            check(pose == poses[body][stamp - start][:7], body, "at", stamp, pose)

    # Each channel that is not on DDS.
    commands = {}
    for row in rows_of(folder + "/commands.csv"):
        commands.setdefault(row["channel"], {}).setdefault(int(row["sent_ns"]), []).append(float(row["value"]))
    kinds = {name: kind for name, kind, *_ in bag.topics}
    carried = [name for name in kinds if name.startswith("/channels/")]
    check({kinds[name] for name in carried} == {"nav_msgs/msg/Odometry", "geometry_msgs/msg/Wrench"}, kinds)
    for name in carried:
        if kinds[name] == "nav_msgs/msg/Odometry":
            check(len(bag.samples[name]) > 100, name, "has", len(bag.samples[name]), "readings")
            for stamp, fields in bag.samples[name]:
                check(stamp_of(fields) <= stamp, name, fields[:2], stamp)
                check_state(name, fields, stamp_of(fields) - start)
        else:
            acted = commands[name.removeprefix("/channels/")]
            check(len(acted) > 20, name, "has", len(acted), "commands")
            check([(stamp - start, fields) for stamp, fields in bag.samples[name]] == list(acted.items()), name)


def topics(folder, *meant):
    bag = read_bag(folder)
    found = {f"{name}:{kind}" for name, kind, *_ in bag.topics
             if any(not is_own(name) or name == "/tf" and not is_of_world(name, s) for s in bag.samples[name])}
    check(found == set(meant), "the bag has", sorted(found), "and not", sorted(meant))


if __name__ == "__main__":
    {"example": example, "witness": witness, "same": same, "cut-off": cut_off,
     "topics": topics, "world": world, "alike": alike}[sys.argv[1]](*sys.argv[2:])
