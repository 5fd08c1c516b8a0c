#!/usr/bin/env bash
source "$(dirname -- "${BASH_SOURCE[0]}")/common.sh"
# Timers, workers and child processes of Node.js.
# Topics: languages, timers, threads, processes.
command -v node >/dev/null || exit 77
program=$(mktemp --suffix .js)
trap 'rm -f "$program"' EXIT
cat >"$program" <<'JS'
const { Worker, isMainThread, parentPort } = require('worker_threads');
const start = process.hrtime.bigint();
// Node.js counts from when its loop last looked at the clock; and starting interpreters takes time.
const say = what => console.log(what, Math.floor((Number(process.hrtime.bigint() - start) / 1e9 + 0.1) * 2) / 2);
if (isMainThread) {
  setTimeout(() => say('timeout'), 5000);
  let turns = 0;
  const interval = setInterval(() => { say('interval'); if (++turns == 2) clearInterval(interval); }, 1000);
  const worker = new Worker(__filename);
  worker.on('message', message => { say(message); });
  require('child_process').exec('sleep 8; echo child', (error, out) => say(out.trim()));
} else {
  setTimeout(() => parentPort.postMessage('worker'), 3000);
}
JS
wanted='interval 1
interval 2
worker 3
timeout 5
child 8'
for accounting in measured fixed; do
  said=$("$tcsim" exec --accounting "$accounting" -- node "$program")
  [[ $said == "$wanted" ]] || fail "$accounting: $said"
done
