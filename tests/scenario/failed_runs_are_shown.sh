#!/usr/bin/env bash
source "$(dirname -- "${BASH_SOURCE[0]}")/common.sh"
# The runs that one wants to look at most have an answer and a page: one whose controller crashes, one that is stopped by
# Ctrl-C, one that is killed. The verdict's first sentence is the cause; the page begins with it, and says what is missing.
# Topics: verdict, report, failures.
out=$(mktemp -d)
trap 'rm -rf "$out"' EXIT
cd "$out"
"$tcsim" new hover >/dev/null
cd hover
says() { grep -q -- "$1" "$out/said" || fail "nobody said '$1': $(cat "$out/said")"; }
# The page's first section is the verdict, which begins so.
begins() {  # FOLDER SENTENCE
  "$tcsim" report "$1" --out "$out/page.html" >"$out/said" 2>&1 || fail "report refuses $1: $(cat "$out/said")"
  python3 - "$out/page.html" "$2" <<'PY' || fail "the page of $1 does not begin with '$2'"
import html, re, sys
page = open(sys.argv[1], encoding="utf-8").read()
first = re.search(r"<section.*?</section>", page, re.S)[0]
words = html.unescape(re.sub(r"<[^>]+>", " ", first)).replace("\u00a0", " ")
assert re.search(sys.argv[2], words), words[:1000]
PY
}
# Shows the page of a folder, as `tcsim view` does.
view() {  # FOLDER SENTENCE
  local server url=
  : >"$out/viewed"
  timeout 300 "$tcsim" view "$1" >"$out/viewed" 2>&1 & server=$!
  for ((i = 0; i < 2000; ++i)); do  # beside runs that have the processors it gets little of them
    url=$(grep -o 'http://[^ ,;]*' "$out/viewed" | head -1) && [[ $url ]] && break
    kill -0 $server 2>/dev/null || fail "view refuses $1: $(cat "$out/viewed")"
    sleep 0.05
  done
  python3 -c 'import sys, urllib.request; sys.stdout.write(urllib.request.urlopen(sys.argv[1], timeout=150).read().decode())' \
    "$url" >"$out/shown.html"
  kill $server; wait $server 2>/dev/null || true
  grep -q -- "$2" "$out/shown.html" || fail "the page at $url does not say '$2'"
}

# A controller that crashes at 1.35 s.
cp controller.py well.py
sed -i 's/^    force\[2\] +=/    if time.monotonic() - begun > 1.35: raise RuntimeError("the gains are gone")\n&/; s/^import json/import json, time\nbegun = time.monotonic()/' controller.py
status=0
"$tcsim" run --duration 3s --accounting fixed --out crashed >"$out/said" 2>&1 || status=$?
((status == 1)) || fail "exit status $status: $(cat "$out/said")"
crash='hover/controller ended at 1\.[34][0-9]* s with exit status 1: "RuntimeError: the gains are gone" (hover-controller.err.log)'
grep '^! ' "$out/said" | head -1 | grep -q "^! $crash" || fail "the crash is not what is said first: $(cat "$out/said")"
python3 -c 'import json, re, sys; [first, *_] = json.load(open("crashed/summary.json"))["verdict"]; assert re.match(sys.argv[1].replace("(", r"\(").replace(")", r"\)"), first), first' "$crash" ||
  fail "the crash is not the verdict's first sentence"
begins crashed 'hover/controller ended at 1\.[34]\d* s with exit status 1: "RuntimeError: the gains are gone"'
grep -q 'id="world"' "$out/page.html" || fail "the page of a crash shows no world"
view crashed 'RuntimeError: the gains are gone'

# By a signal.
sed -i 's/raise RuntimeError("the gains are gone")/os.kill(os.getpid(), 11)/; s/^import json, time/import json, os, time/' controller.py
"$tcsim" run --duration 3s --accounting fixed --out crashed >"$out/said" 2>&1 && fail "a crash is no success"
says '^! hover/controller ended at 1\.[34][0-9]* s with signal 11 (Segmentation fault): it printed nothing'

# Ctrl-C; then SIGKILL, which leaves no summary.
cp well.py controller.py
for signal in INT KILL; do
  env --default-signal=INT "$tcsim" run --duration 1000s --accounting fixed --out stopped-$signal >"$out/said" 2>&1 & run=$!
  for ((i = 0; i < 4000; ++i)); do  # it may have to wait for a processor first
    [[ -s stopped-$signal/dispatches.csv ]] && (($(wc -c <stopped-$signal/dispatches.csv) > 20000)) && break
    kill -0 $run 2>/dev/null || fail "it ended by itself: $(cat "$out/said")"
    sleep 0.05
  done
  pid=$run
  [[ $signal == INT ]] || pid=$(coordinator_of $run)
  kill -$signal "$pid"
  wait $run 2>/dev/null || true
  [[ $signal == KILL ]] || says '^! SIGINT stopped the run at [0-9.]* s of its 1000 s'
done
begins stopped-INT 'SIGINT stopped the run at [0-9.]+ s of its 1000 s'
view stopped-INT 'SIGINT stopped the run'
[[ ! -e stopped-KILL/summary.json ]] || fail "a killed run has a summary"
begins stopped-KILL 'the run was cut off soon after'
says 'nothing is known of deadlines'
rm -f stopped-KILL/unfinished.json
begins stopped-KILL 'the run was cut off soon after'
says 'has no summary.json, so that nothing is known of deadlines'
