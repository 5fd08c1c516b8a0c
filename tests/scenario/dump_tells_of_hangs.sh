#!/usr/bin/env bash
source "$(dirname -- "${BASH_SOURCE[0]}")/common.sh"
source "$source_root/tests/as_nobody.sh"
# `tcsim dump` says of a run that goes on what each thread does or waits for, since when, until when and on whom. It
# changes nothing of the run. Of a coordinator that does not answer it says so, and what can be seen from outside.
# What cannot be asked is one sentence.
# Topics: dump, failures.
out=$(mktemp -d)
chmod 755 "$out"
runs=()
trap 'for run in "${runs[@]}"; do kill -CONT "$run" 2>/dev/null; kill -TERM "$run" 2>/dev/null; wait "$run" 2>/dev/null
      done || true; rm -rf "$out"' EXIT

# Until a dump of the process's run is what the check (in Python, of `state` and `threads`) says.
dump_says() {
  local pid=$1 check=$2 tries=0
  shift 2
  until "$@" "$tcsim" dump --json "$pid" >"$out/state.json" 2>"$out/stderr" && python3 - "$out/state.json" "$check" <<'PY' 2>"$out/why"
import json, sys
state = json.load(open(sys.argv[1]))
processes = [p for r in state.get("robots", []) for p in r["processes"]] or state["outside"]["processes"]
threads = {t["kernel"]["name"]: t for p in processes for t in p["threads"] if t["kernel"]}
exec(sys.argv[2])
PY
  do
    [ -e "/proc/$pid" ] || fail "the run has ended: $(cat "$out/run.err")"
    ((++tries < 300)) || fail "dump: $(cat "$out/stderr" "$out/why" "$out/state.json")"
    sleep 0.2
  done
}
says() { # PATTERN COMMAND...: in one line on stderr, with status 2
  local pattern=$1 status=0
  shift
  "$@" >"$out/stdout" 2>"$out/stderr" || status=$?
  sed -i '/^tcsim: other runs of tcsim have the processors/d' "$out/stderr" # of somebody else's runs
  ((status == 2)) && [[ $(wc -l <"$out/stderr") == 1 ]] && grep -Eq "^tcsim: $pattern\$" "$out/stderr" ||
    fail "'$*' ends with $status: $(cat "$out/stderr"), not '$pattern'"
}
await_state() { # LETTER PID
  for _ in $(seq 600); do  # whoever is stopped has to get a processor for that
    [[ $(sed 's/.*) //' "/proc/$2/stat" | cut -c1) == "$1" ]] && return
    sleep 0.05
  done
  fail "process $2 does not come to state $1"
}

"$tcsim" exec -- "$build/bin/waiting_threads" >"$out/run.out" 2>"$out/run.err" &
run=$!
runs+=("$run")
dump_says "$run" '
assert state["answered"] and set(threads) >= {"waiting_threads", "locker", "sleeper", "reader", "worker"}, threads
first = threads["waiting_threads"]["tid"]
locker, sleeper, reader, worker = (threads[n] for n in ("locker", "sleeper", "reader", "worker"))
now = state["time"]["virtual_ns"]
assert locker["state"] == "waiting" and locker["futex"]["owner"] == first and locker["until_ns"] is None, locker
assert threads["waiting_threads"]["text"] == "waits for thread %d" % worker["tid"], threads
assert sleeper["state"] == "sleeping" and sleeper["text"] == "sleeps", sleeper
assert abs(sleeper["until_ns"] - sleeper["since_ns"] - 3_000_000_000_000_000) < 1_000_000, sleeper
assert reader["state"] == "waiting" and reader["until_ns"] is None, reader
assert reader["text"].startswith("waits for input at descriptor ") and reader["text"].endswith("(a socket)"), reader
assert worker["state"] in ("running", "ready") and worker["policy"] == "SCHED_OTHER", worker
for waiting in (locker, sleeper, reader): assert 0 <= waiting["since_ns"] < 500_000_000 < now, (waiting, now)
assert worker["charged_ns"] > 0.8 * now, (worker, now)
assert [w["waiters"] for w in state["queues"]["futexes"] if locker["tid"] in w["waiters"]] == [[locker["tid"]]]
'
first_time=$(python3 -c 'import json, sys; print(json.load(open(sys.argv[1]))["time"]["virtual_ns"])' "$out/state.json")
dump_says "$run" "assert state['time']['virtual_ns'] > $first_time"

# As people read it, on a terminal.
script -qec "stty cols 70; '$tcsim' dump $run" /dev/null | tr -d '\r' >"$out/text"
for line in 'locker waits for a lock or a condition that thread [0-9]+ has, since' 'sleeper sleeps, since [0-9.]+ s, until 3000000\.' \
  'reader waits for input at descriptor [0-9]+ \(a socket\), since' 'worker (runs|is ready)' \
  'the coordinator answered in' 'virtual time [0-9.]+ s'; do
  tr -s '\n ' ' ' <"$out/text" | grep -E "$line" >/dev/null || fail "the text lacks '$line': $(cat "$out/text")"
done
(($(wc -L <"$out/text") <= 70)) || fail "wider than the terminal: $(cat "$out/text")"

# By any of its processes, and only by whom it belongs to.
coordinator=$(coordinator_of "$run" | head -n 1)
client=$(pgrep -x waiting_threads -P "$coordinator")
"$tcsim" dump "$client" | grep "^run of process $coordinator" >/dev/null || fail "not by the client's number"
if ((EUID == 0)); then
  install_for_everybody "$build" "$out" waiting_threads
  says "process $run is root's: only root may ask for the state of its run" "${nobody[@]}" "$out/bin/tcsim" dump "$run"
fi
sleep 100 &
sleeping=$!
says "process $sleeping belongs to no run of tcsim that has begun" "$tcsim" dump "$sleeping"
kill "$sleeping"
says 'there is no process 99999999' "$tcsim" dump 99999999
says "there is no folder '$out/none'" "$tcsim" dump "$out/none"
says "no run writes to the folder '$out' just now" "$tcsim" dump "$out"

# A second one, which waits for a processor, where the first has the only one, or for ever.
"$tcsim" exec -- python3 -c 'import threading; threading.Lock().acquire(); threading.Event().wait()' >/dev/null 2>&1 9>&- &
second=$!
runs+=("$second")
for _ in $(seq 300); do
  "$tcsim" dump "$$" >"$out/stdout" 2>"$out/stderr" || true
  grep -q '^tcsim: [0-9]* runs go on' "$out/stderr" && break
  sleep 0.1
done
# More than two where somebody else's go on, too.
says '[0-9]+ runs go on: (process [0-9]+ \(.*\), )+process [0-9]+ \(.*\); name one, as in `tcsim dump [0-9]+`' \
  "$tcsim" dump "$$"
kill -TERM "$second"
wait "$second" || true

# A coordinator that is stopped together with its guardian is left so: it cannot answer.
kill -STOP "$run"
await_state T "$run"
kill -STOP "$coordinator"
await_state T "$coordinator"
"$tcsim" dump "$run" >"$out/text" &
text=$!
dump_says "$run" '
assert not state["answered"] and state["coordinator"]["kernel"]["state"] == "T", state
assert state["coordinator"]["waited_ns"] >= 2_000_000_000, state
assert set(threads) >= {"waiting_threads", "locker", "sleeper", "reader", "worker"}, threads
assert threads["reader"]["slot"]["asked"] == "to wait for descriptors", threads["reader"]
assert threads["worker"]["kernel"]["processor_ns"] > 0, threads["worker"]
'
wait "$text"
# Two seconds, and what the dump itself waits for a processor.
grep -Eq '^the coordinator does not answer: ([2-9]|[1-9][0-9])[0-9]{3} ms of waiting, in which it computed for 0 ns; the kernel has it stopped by a signal' \
  "$out/text" || fail "of one that is stopped: $(cat "$out/text")"
grep -q '^Seen from outside' "$out/text" || fail "$(cat "$out/text")"
kill -CONT "$coordinator" "$run"
dump_says "$run" 'assert state["answered"]'
kill -TERM "$run"
wait "$run" || true

# From inside a run.
says 'a run cannot ask for its own state: call `tcsim dump` outside of it' "$tcsim" exec -- "$tcsim" dump

# Whoever has no rights may ask, too.
if ((EUID == 0)); then
  (cd / && exec "${nobody[@]}" "$out/bin/tcsim" exec -- "$out/bin/waiting_threads" >"$out/run.out" 2>"$out/run.err") &
  run=$!
  runs+=("$run")
  tcsim=$out/bin/tcsim dump_says "$run" '
assert state["answered"] and not state["run"]["levels"], state
assert threads["sleeper"]["state"] == "sleeping" and threads["reader"]["state"] == "waiting", threads
' "${nobody[@]}"
  kill -TERM "$run"
  wait "$run" || true
fi

# It changes nothing of a run whose bytes can be told: so many runs that they were asked often.
flies() { # FOLDER
  "$tcsim" run "$build/examples/predator_prey/scenario.yaml" --accounting fixed --duration 3s --out "$out/$1" >"$out/$1.said" 2>&1
}
flies without || fail "$(cat "$out/without.said")"
asked=0
while ((asked <= 3)); do
  flies with &
  flying=$!
  while [[ -e /proc/$flying ]]; do
    "$tcsim" dump --json "$out/with" >"$out/state.json" 2>/dev/null && ((++asked)) || true
  done
  wait "$flying" || fail "$(cat "$out/with.said")"
  for file in bodies.csv commands.csv output.csv messages.csv trace.json activations.csv dispatches.csv; do
    cmp "$out/without/$file" "$out/with/$file" ||
      fail "$file differs after $asked dumps: $(diff "$out/without/$file" "$out/with/$file" | head -n 20;
        cat "$out/without.said" "$out/with.said")"
  done
done
