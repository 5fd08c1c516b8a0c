#!/usr/bin/env bash
source "$(dirname -- "${BASH_SOURCE[0]}")/common.sh"
# A TCP connection to a program outside of the run takes the virtual time that its real time stands for, however the client
# waits for it: in connect, with a timeout that is far longer, in an event loop. A first request on it is answered as soon as
# it is natively. Under set costs the connection takes what was set.
#
# The server has room for one connection, and has made that itself: what the client asks for first is lost, and asked for
# once more by the kernel after a second, when there is room.
# Topics: outside, tcp, determinism.
out=$(mktemp -d)
server=
trap 'kill "$server" 2>/dev/null || true; rm -rf "$out"' EXIT
cd "$out"
port=27523
cat >server.py <<'PY'
import os, socket, sys, time
port = int(sys.argv[1])
while True:
    listener = socket.socket()
    listener.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
    listener.bind(("127.0.0.1", port))
    listener.listen(0)
    ours = socket.create_connection(("127.0.0.1", port))
    open("full", "w").close()
    while not os.path.exists("begins"): time.sleep(0.001)
    begun = os.stat("begins").st_mtime  # real time, whenever this process has had the processor
    os.unlink("begins")
    os.unlink("full")  # before the client can end: the next one waits for the next
    time.sleep(0.3)
    others = listener.accept()[0], listener.accept()[0]
    took = (time.time() - begun) * 1e3
    try:
        others[1].recv(1)
        with open("took", "w") as f: f.write(f"{took:.3f} {(time.time() - begun) * 1e3:.3f}")
        others[1].send(b"x")
        others[1].recv(1)
    except OSError: pass
    for each in *others, ours, listener: each.close()
PY
cat >client.py <<'PY'
# client.py PORT WAY: prints how long it took to be connected, and until a request was answered, in ms.
import asyncio, os, socket, sys, time
to, way = ("127.0.0.1", int(sys.argv[1])), sys.argv[2]
while not os.path.exists("full"): time.sleep(0.01)
open("begins", "w").close()
begun = time.monotonic()
async def connect():
    _, writer = await asyncio.open_connection(*to)
    return writer.get_extra_info("socket").dup()
if way == "waiting":
    s = socket.socket()
    s.connect(to)
elif way == "timeout": s = socket.create_connection(to, timeout=50)
elif way == "loop": s = asyncio.run(connect())
connected = time.monotonic()
s.setblocking(True)
s.send(b"q")
s.recv(1)
print(f"{(connected - begun) * 1e3:.3f} {(time.monotonic() - connected) * 1e3:.3f}")
PY
# Runs have the processors, and the server is to be as quick as one on another computer.
on_time python3 server.py "$port" &
server=$!
for way in waiting timeout loop; do
  timeout 200 "$tcsim" exec -- python3 client.py "$port" "$way" >took-by-client 2>said || fail "$way: $(cat said)"
  read -r connected answered <took-by-client
  # The kernel asks again after a second; when the server finds that out, and comes to answer, is a busy host's.
  awk -v connected="$connected" -v answered="$answered" \
    '{ exit !(connected >= 940 && connected <= 1.05 * $1 + 1 && connected + answered <= 1.05 * $2 + 20) }' took ||
    fail "$way: connected after $connected ms, answered after $answered; by the server $(cat took) since the begin"
  timeout 200 "$tcsim" exec --accounting fixed --outside-takes 20ms -- python3 client.py "$port" "$way" >fixed 2>said ||
    fail "$way, set costs: $(cat said)"
  awk '$1 < 20 || $1 >= 20.5 || $2 < 20 || $2 >= 20.1 { exit 1 }' fixed || fail "$way, set costs: $(cat fixed)"
done
[[ -z $(new_in_shm) ]] || fail "left in /dev/shm: $(new_in_shm)"
