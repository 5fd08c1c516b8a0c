#!/usr/bin/env bash
source "$(dirname -- "${BASH_SOURCE[0]}")/common.sh"
# While the kernel holds the process whose turn it is, the child that it has just made gets the
# processor, and comes to register before its own turn: nothing of a fixed run may depend on that.
# Topics: determinism, processes.
out=$(mktemp -d)
trap 'kill ${writer:-} 2>/dev/null || true; rm -rf "$out"' EXIT
mkfifo "$out/fifo"
cat >"$out/scenario.yaml" <<END
duration: 1s
robots:
  robot:
    cpu: {cores: 2}
    clients:
      maker:
        command:
          - python3
          - -c
          - |
            import ctypes, os, time
            outside = os.open("$out/fifo", os.O_RDWR)
            read_end, write_end = os.pipe()
            with open("$out/said", "w") as said:
                said.write(os.environ["TCS_SOCKET"])
            # Python's own, from 3.12 on, looks into /proc for threads, and meanwhile the child would have its turn.
            child = ctypes.CDLL(None).fork()
            if child == 0:
                time.sleep(0.1)
                os._exit(0)
            os.rename("$out/said", "$out/waits")
            os.splice(outside, write_end, 1)
            os.waitpid(child, 0)
            time.sleep(0.1)
      other: {command: [sh, -c, "sleep 0.01; sleep 0.01"]}
END
fly() { # NAME: a run; dispatches and activations are printed
  timeout 200 "$tcsim" run "$out/scenario.yaml" --accounting fixed --out "$out/$1" >"$out/$1.said" 2>&1 ||
    fail "$1: status $?: $(cat "$out/$1.said")"
  cat "$out/$1/dispatches.csv" "$out/$1/activations.csv"
}
exec 7<>"$out/fifo"
# What the maker takes is there; and is there a while after it has begun to wait for it.
printf x >&7
at_once=$(fly at_once)
# Meanwhile the child connects, and has no answer. On a busy host it may come to that only after the second for which a held
# process is waited for.
for round in 1 2 3 4 5 6; do
  rm -f "$out/waits"
  (
    until [[ -e $out/waits ]]; do sleep 0.02; done
    for _ in $(seq 100); do
      sleep 0.02
      grep -q " 03 *[0-9]* @$(cat "$out/waits")\$" /proc/net/unix && touch "$out/early" && break
    done
    printf x >&7
  ) &
  writer=$!
  later=$(fly later$round)
  wait "$writer"
  [[ ! -e $out/early ]] || break
done
[[ -e $out/early ]] || fail 'the child did not come to register while its maker was held'
diff <(echo "$at_once") <(echo "$later") >"$out/diff" || fail "$(head -20 "$out/diff")"
