#!/usr/bin/env bash
source "$(dirname -- "${BASH_SOURCE[0]}")/common.sh"
# A robot's programs open /dev/ttyUSB0: Python's termios, C's with VTIME, stdio, socat. Each byte takes the time of its
# bits in both directions, to the nanosecond.
# Topics: serial, languages.
out=$(mktemp -d)
trap 'rm -rf "$out"' EXIT
cat >"$out/bytes.py" <<'PY'
import ctypes, os, select, sys, termios, time, tty
now = lambda: time.monotonic_ns() - 10**12
assert os.path.exists("/dev/ttyUSB0") and not os.path.exists("/dev/ttyUSB9")
libc, status = ctypes.CDLL(None), ctypes.create_string_buffer(144)
for old in "__xstat", "__lxstat64":  # of programs built long ago
    assert getattr(libc, old)(1, b"/dev/ttyUSB0", status) == 0 and getattr(libc, old)(1, b"/dev/ttyUSB9", status) != 0
fd = os.open("/dev/ttyUSB0", os.O_RDWR | os.O_NOCTTY)
assert termios.tcgetattr(fd)[4] == termios.B115200
tty.setraw(fd)
for block in (True, False):
    os.set_blocking(fd, block)
    line, times = b"", []
    while not line.endswith(b"\n"):
        if not block: select.select([fd], [], [])
        line += os.read(fd, 1)
        times.append(now())
    print("read", len(line), *times)
before = now()
os.write(fd, b'{"force": [1, 0, 0]}\n{"force": [0, 0, 0]}\n')
print("wrote", before, now())
PY
cat >"$out/timeouts.c" <<'C'
#include <fcntl.h>
#include <stdio.h>
#include <termios.h>
#include <time.h>
#include <unistd.h>
static long Now(void) {
  struct timespec t;
  clock_gettime(CLOCK_MONOTONIC, &t);
  return (t.tv_sec - 1000) * 1000000000L + t.tv_nsec;
}
int main(void) {
  char line[512];
  struct termios settings;
  const int fd = open("/dev/ttyUSB0", O_RDWR | O_NOCTTY);
  tcgetattr(fd, &settings);
  settings.c_cc[VMIN] = 0, settings.c_cc[VTIME] = 5;
  tcsetattr(fd, TCSANOW, &settings);
  long silent;
  ssize_t bytes;
  do {
    silent = Now();
    bytes = read(fd, line, sizeof line);  // the next line comes at 1 s
  } while (bytes > 0);
  printf("timeout %ld %zd\n", Now() - silent, bytes);
  settings.c_cc[VTIME] = 0;
  tcsetattr(fd, TCSANOW, &settings);
  printf("at_once %zd\n", read(fd, line, sizeof line));
  settings.c_lflag |= ICANON;
  tcsetattr(fd, TCSANOW, &settings);
  printf("line %zd", read(fd, line, sizeof line));
  printf(" %ld\n", Now());
  FILE* device = fdopen(fd, "r+");
  fprintf(device, "{\"force\": [1, 0, 0]}\n");
  fflush(device);
  printf("wrote %ld\n", Now());
  fflush(stdout);
  return 0;
}
C
gcc -O1 -Wall "$out/timeouts.c" -o "$out/timeouts"
scenario() {  # COMMAND RATE
  cat <<YAML
duration: 4s
dynamics: {}
bodies: {ship: {mass: 1, inertia: [0.1, 0.1, 0.1]}, other: {mass: 1, inertia: [0.1, 0.1, 0.1]}}
robots:
  r: {clients: {c: {command: $1, body: ship}}}
  q: {clients: {c: {command: [sleep, "5"]}}}
channels:
  eyes: {type: pty, sensors: {bodies: [ship], rate: $2, latency: 1ms, device: /dev/ttyUSB0, robot: r}}
  hands: {type: pty, commands: {body: ship, latency: 2ms, device: /dev/ttyUSB0, robot: r}}
  others: {type: pty, sensors: {bodies: [other], rate: 1, device: /dev/ttyUSB0, robot: q}}
YAML
}
run() { "$tcsim" run "$out/s.yaml" --out "$out/run" "$@" >"$out/said" 2>&1 || fail "$(cat "$out/said" "$out/run/"*.err.log)"; }
scenario '[python3, bytes.py]' 10 >"$out/s.yaml"
for accounting in fixed measured; do
  run --accounting $accounting
  python3 - "$out/run" $accounting <<'PY' || fail "$accounting: $(cat "$out/run/r-c.out.log" "$out/said")"
import csv, sys
folder, accounting = sys.argv[1:]
exact = accounting == "fixed"
byte = lambda count: -(-count * 10 * 10**9 // 115200)  # ns, rounded up
lines = [line.split() for line in open(folder + "/r-c.out.log")]
for words in lines[:2]:  # the first one from somewhere in the middle
    size, times = int(words[1]), [int(t) for t in words[2:]]
    sample = times[-1] // 100_000_000 * 100_000_000
    late = times[-1] - (sample + 1_000_000 + byte(size))
    assert words is lines[0] or 0 <= late < (10_000 if exact else 5_000_000), late
    if exact:
        gaps = [b - a for a, b in zip(times, times[1:])]
        assert max(gaps) - min(gaps) < 3000 and abs(sum(gaps) / len(gaps) - 86805.6) < 100, gaps
_, before, after = lines[2]
rows = [(float(row["time_s"]), float(row["vx_mps"])) for row in csv.DictReader(open(folder + "/bodies.csv")) if row["body"] == "ship"]
push = rows[-1][1] * 1e9
assert abs(push - 21 * 10 / 115200 * 1e9) < 2, push  # from the last bit of one line to that of the next one
x = float([row for row in csv.DictReader(open(folder + "/bodies.csv")) if row["body"] == "ship"][-1]["x_m"])
start = 4 - x / rows[-1][1] - push / 2e9   # s: when the push began
begun = start * 1e9 - 2_000_000 - byte(21)
assert int(before) - 1000 <= begun <= int(after) + 1000, (begun, before, after)
PY
done
scenario '[./timeouts]' 1 >"$out/s.yaml"
run --accounting fixed
grep -Eq '^timeout 50000[0-9]{4} 0$' "$out/run/r-c.out.log" && grep -q '^at_once 0$' "$out/run/r-c.out.log" &&
  grep -Eq '^line 17[0-9] 1016[0-9]{6}$' "$out/run/r-c.out.log" || fail "$(cat "$out/run/r-c.out.log")"
tail -2 "$out/run/bodies.csv" | grep -Eq '^4.000000000,ship,.*,2\.98[0-9]*,0,0,0,0,0$' || fail "a command by stdio has not come: $(tail -2 "$out/run/bodies.csv")"

# What a line cannot carry is left out and named, and so is a program that sets another rate.
scenario '[python3, -c, "import os, termios; fd = os.open(\"/dev/ttyUSB0\", os.O_RDWR); a = termios.tcgetattr(fd); a[4] = a[5] = termios.B9600; termios.tcsetattr(fd, 0, a); n = sum(len(os.read(fd, 64)) for i in range(2000))"]' 100 >"$out/s.yaml"
run --accounting fixed --set channels.eyes.sensors.fifo=16 --duration 2s
grep -q 'warning: a program of r has set /dev/ttyUSB0 to 9600 baud, but the line has 115200 in the scenario' "$out/said" || fail "$(cat "$out/said")"
grep -Eq 'warning: channel eyes: 100 of its 200 readings were left out because the line was busy: a reading of 17[0-9] bytes takes 15.[0-9] ms at 115200 baud, and readings are 10.0 ms apart; lower the rate' "$out/said" || fail "$(cat "$out/said")"
grep -q 'warning: channel others: no program of q has opened /dev/ttyUSB0, so the samples for it are lost; let a client open it' "$out/said" || fail "$(cat "$out/said")"

command -v socat >/dev/null || { echo "socat is not installed"; exit 77; }
scenario '[sh, -c, "(sleep 1; echo \"{\\\"force\\\": [1, 0, 0]}\"; sleep 9) | socat - /dev/ttyUSB0,raw,echo=0,b115200"]' 10 >"$out/s.yaml"
run --accounting fixed
(($(grep -c '^{"time":.*}}}$' "$out/run/r-c.out.log") >= 38)) || fail "socat has read $(wc -l <"$out/run/r-c.out.log") lines"
tail -2 "$out/run/bodies.csv" | grep -Eq '^4.000000000,ship,[^,]*,.*,2\.99[0-9]*,0,0,0,0,0$' || fail "socat's command has not come: $(tail -2 "$out/run/bodies.csv")"
