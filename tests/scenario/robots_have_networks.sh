#!/usr/bin/env bash
source "$(dirname -- "${BASH_SOURCE[0]}")/common.sh"
# Two robots with a program each on port 5000, 20 ms between them: each has its own host name,
# addresses and ports, finds the other by its name, and reads 20 ms later what the other has written,
# by UDP and by TCP. None of the programs was written for this. In `fixed` two runs of it, also at
# once, write the same bytes.
# Topics: network, udp, tcp, determinism.
command -v python3 > /dev/null || exit 77
"$source_root/tests/scenario/can_have_networks.sh" || exit 77
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
cat > "$scratch/robot.py" << 'END'
import os, platform, socket, sys, time

me, other = sys.argv[1], sys.argv[2]
names = {socket.gethostname(), platform.node(), os.uname().nodename,
         open("/proc/sys/kernel/hostname").read().strip(), open("/etc/hostname").read().strip()}
assert names == {me}, names
assert socket.gethostbyname(other) == {"predator": "10.42.0.1", "prey": "10.42.0.2"}[other]

# On the robot itself: port 5000 of every address, whoever else has it.
listener = socket.create_server(("", 5000))
datagrams = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
datagrams.bind(("0.0.0.0", 5000))
assert datagrams.getsockname() == ("0.0.0.0", 5000)
near = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
near.sendto(b"near", ("127.0.0.1", 5000))
assert datagrams.recv(100) == b"near"
six = socket.create_server(("::1", 5000), family=socket.AF_INET6)
six_too = socket.create_connection(("::1", 5000))
six.accept()[0].sendall(b"six")
assert six_too.recv(100) == b"six"

def ms(since):
    return (time.monotonic() - since) * 1000

# Both are there by then.
time.sleep(1 - time.monotonic() % 1)
if me == "predator":
    for _ in range(3):
        began = time.monotonic()
        near.sendto(b"far", (other, 5000))
        data, sender = near.recvfrom(100)
        print("udp", data, sender, round(ms(began), 3))
    began = time.monotonic()
    connection = socket.create_connection((other, 5000))
    print("connected", round(ms(began), 3), connection.getpeername(), connection.getsockname()[0])
    began = time.monotonic()
    connection.sendall(b"far")
    print("tcp", connection.recv(100), round(ms(began), 3))
    try:
        socket.create_connection((other, 5001))
    except ConnectionRefusedError:
        print("refused", round(ms(began), 3))
    try:
        near.sendto(b"nobody", ("10.42.0.99", 5000))
    except OSError as error:
        print("nobody", error.strerror)
else:
    for _ in range(3):
        data, sender = datagrams.recvfrom(100)
        datagrams.sendto(data.upper(), sender)
        print("from", sender[0])
    connection, peer = listener.accept()
    connection.sendall(connection.recv(100).upper())
    print("from", peer[0])
    assert connection.recv(100) == b""
END
cat > "$scratch/two.yaml" << 'END'
duration: 20s
network: {latency: 20ms}
robots:
  predator: {clients: {program: {command: [python3, "${scenario_dir}/robot.py", predator, prey]}}}
  prey: {clients: {program: {command: [python3, "${scenario_dir}/robot.py", prey, predator]}}}
END
said() { cat "$scratch/$1/predator-program."{out,err}.log "$scratch/$1/prey-program."{out,err}.log; }
run() {
  "$tcsim" run "$scratch/two.yaml" --accounting "$1" --out "$scratch/$2" > "$scratch/$2.said" 2>&1 ||
    fail "$2: $(cat "$scratch/$2.said") $(said "$2")"
}
run measured measured
run fixed first & one=$!
run fixed second & two=$!
wait $one || fail "the first of two runs at once failed"
wait $two || fail "the second of two runs at once failed"
for name in measured first second; do
  said "$name" > "$scratch/$name.text"
  python3 - "$scratch/$name.text" "$name" << 'PY' || fail "$name: $(cat "$scratch/$name.said" "$scratch/$name.text")"
import re, sys
text = open(sys.argv[1]).read()
# A way there and one back, and little besides: where it is measured, what the host makes of it, but no way more.
more = 8 if sys.argv[2] == "measured" else 0
udp = [float(t) for t in re.findall(r"udp b'FAR' \('10.42.0.2', 5000\) ([\d.]+)", text)]
assert len(udp) == 3 and all(40 <= t < 41 + more for t in udp), udp
(connected,) = re.findall(r"connected ([\d.]+) \('10.42.0.2', 5000\) 10.42.0.1", text)
(tcp,) = re.findall(r"tcp b'FAR' ([\d.]+)", text)
assert all(40 <= float(t) < 42 + more for t in (connected, tcp)), (connected, tcp)
(refused,) = re.findall(r"refused ([\d.]+)", text)
assert 80 <= float(refused) < 84 + more, refused
assert "nobody Network is unreachable" in text
assert text.count("from 10.42.0.1") == 4
PY
done
for file in trace.json activations.csv dispatches.csv output.csv predator-program.out.log; do
  cmp "$scratch/first/$file" "$scratch/second/$file" || fail "$file differs"
done
