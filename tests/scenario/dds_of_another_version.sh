#!/usr/bin/env bash
source "$(dirname -- "${BASH_SOURCE[0]}")/common.sh"
# A program with another Cyclone DDS than Debian's is told so in one line, and uses sockets.
# Topics: dds, packages, failures.
export CYCLONEDDS_URI='<CycloneDDS><Domain id="any"><General><Interfaces>
  <NetworkInterface name="lo" multicast="true"/></Interfaces></General></Domain></CycloneDDS>'
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
debians=$(realpath "$(library libddsc.so.0debian)")

# In a network of its own: by sockets programs would meet those of other tests.
dds_exec() { "$build/bin/in_own_network" "$tcsim" exec -- "$@"; }

# The very same library is what it is under any name. (What others run may have sockets in its command line.)
mkdir "$work/same"
cp "$debians" "$work/same/libddsc.so.0debian"
said=$(dds_exec env LD_LIBRARY_PATH="$work/same" ddsperf -D 0.1 sanity 2>&1 | without_waits)
grep -q sockets <<<"$said" && fail "a copy of Debian's library is refused: $said"

# Another build has another build id; its version stands in the name of the file, behind the link.
python3 - "$debians" "$work/libddsc.so.9.9.9" <<'END'
import re, subprocess, sys
notes = subprocess.run(["readelf", "-n", sys.argv[1]], capture_output=True, text=True).stdout
build = bytes.fromhex(re.search("Build ID: ([0-9a-f]+)", notes)[1])
library = open(sys.argv[1], "rb").read()
assert library.count(build) == 1
open(sys.argv[2], "wb").write(library.replace(build, build[::-1]))
END
ln -s libddsc.so.9.9.9 "$work/libddsc.so.0debian"
said=$(dds_exec env LD_LIBRARY_PATH="$work" bash -c \
  "ddsperf -D 2 pong & ddsperf -D 2 ping 100Hz; wait" 2>&1)
[[ $(grep -c 'tcs: DDS in shared memory needs '"${debians##*/}"', but this program has .*/libddsc.so.9.9.9, so its DDS uses sockets' \
  <<<"$said") == 2 ]] || fail "not told once by each program: $said"
grep -Eq 'recvUC|mean .* cnt ' <<<"$said" || fail "they have not met: $said"

# With a robot the line would be in a log, so tcsim says at once what the program will not meet.
warned_of() {  # REASON CLIENT
  cat >"$work/scenario.yaml" <<YAML
duration: 1s
clock: {}
robots: {r: {clients: {it: $2, other: {command: [sleep, "1"]}}}}
YAML
  "$build/bin/in_own_network" "$tcsim" run "$work/scenario.yaml" --out "$work/run" >"$work/said" 2>&1 || fail "$(cat "$work/said")"
  [[ $(grep -c "^tcsim: warning: the DDS of r/it uses sockets because $1, so it never meets the scenario's topics in shared memory (/clock); .*, or give the client .dds: sockets., and it meets them there$" \
    "$work/said") == 1 ]] || fail "not warned, or not once: $(cat "$work/said" "$work/run/"*.err.log)"
  grep -q "the DDS of r/it uses sockets" "$work/run/summary.json" || fail "the summary does not have the warning"
}
warned_of "its Cyclone DDS is not Debian's ${debians##*/}" \
  "{command: [ddsperf, -D, '0.5', pub, 10Hz], environment: {LD_LIBRARY_PATH: '$work'}}"

# So is one that brings a library with another name for itself, and looks functions up in it.
sed 's/libddsc\.so\.0debian/libddsc.so.0bundle/' "$work/libddsc.so.9.9.9" >"$work/libddsc-bundled.so"
cmp -s "$work/libddsc.so.9.9.9" "$work/libddsc-bundled.so" && fail "the library has not been renamed"
said=$(dds_exec python3 -c '
import ctypes, sys
ddsc = ctypes.CDLL(sys.argv[1])
participant = ddsc.dds_create_participant(0, None, None)
print("participant", participant > 0, "deleted", ddsc.dds_delete(participant))
' "$work/libddsc-bundled.so" 2>&1)
grep -q "tcs: this program looks up Cyclone DDS's functions by itself, so its DDS uses sockets" <<<"$said" ||
  fail "not told: $said"
grep -q 'participant True deleted 0' <<<"$said" || fail "it does not work: $said"
warned_of "it looks up Cyclone DDS's functions by itself, as Python's ctypes does" \
  "{command: [python3, -c, 'import ctypes; ctypes.CDLL(\"$work/libddsc-bundled.so\").dds_create_participant(0, None, None)']}"

# Who looks functions up in Debian's own has no sockets.
said=$(dds_exec python3 -c '
import ctypes, os, time
def sockets():
    count = 0
    for fd in range(64):
        try:
            count += os.readlink(f"/proc/self/fd/{fd}").startswith("socket:")
        except OSError:
            pass
    return count
before = sockets()
ddsc = ctypes.CDLL("libddsc.so.0debian")
participant = ddsc.dds_create_participant(0, None, None)
time.sleep(0.1)  # its threads have registered by then, which takes a socket each for a moment
print("participant", participant > 0, "sockets", sockets() - before,
      "deleted", ddsc.dds_delete(participant))
' 2>&1 | without_waits)
[[ $said == "participant True sockets 0 deleted 0" ]] || fail "looked up in Debian's: $said"
