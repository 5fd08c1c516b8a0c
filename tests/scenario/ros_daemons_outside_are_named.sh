#!/usr/bin/env bash
source "$(dirname -- "${BASH_SOURCE[0]}")/common.sh"
# ROS 2's command line asks whoever listens at the port of its domain's daemon. One that was started outside of the run knows nothing
# of it, and is named; one of the run is not.
# Topics: ros, failures, tcp.
out=$(mktemp -d)
trap 'kill "$daemon" 2>/dev/null || true; wait; rm -rf "$out"' EXIT
export ROS_DOMAIN_ID=229
# In the places of the daemon and of `ros2`, as far as processes and sockets are concerned.
cat >"$out/daemon.py" <<'PY'
import socket, sys
server = socket.create_server(("127.0.0.1", 11511 + 229), backlog=8)
print("listens", flush=True)
while True: server.accept()[0].close()
PY
cat >"$out/ros2" <<'PY'
#!/usr/bin/python3
import socket
socket.create_connection(("127.0.0.1", 11511 + 229)).recv(1)
PY
chmod +x "$out/ros2"
says() { "$tcsim" exec -- "$out/ros2" "$@" >"$out/said" 2>&1 || fail "$*: $(cat "$out/said")"; }
named='`ros2 node list` asks the ros2 daemon at 127.0.0.1:11740, which was started outside of the run'

# While others have all processors it would not answer, and the run would say after 5 s that time stands still.
on_time python3 "$out/daemon.py" >"$out/listens" & daemon=$!
for _ in $(seq 600); do [[ -s $out/listens ]] && break; sleep 0.1; done
says node list
grep -qF "$named" "$out/said" || fail "not named: $(cat "$out/said")"
for command in 'topic hz /odom' 'node list --no-daemon' 'launch a b'; do
  # shellcheck disable=SC2086  # words of a command
  says $command
  [[ -z $(without_waits <"$out/said") ]] || fail "$command: $(cat "$out/said")"
done
kill "$daemon"
wait "$daemon" 2>/dev/null || true

# That of the run itself.
"$tcsim" exec -- sh -c "python3 $out/daemon.py & sleep 1; $out/ros2 node list; kill \$!" >"$out/said" 2>&1 || fail "$(cat "$out/said")"
[[ $(without_waits <"$out/said") == listens ]] || fail "one of the run: $(cat "$out/said")"
