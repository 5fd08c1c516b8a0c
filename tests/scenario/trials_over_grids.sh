#!/usr/bin/env bash
source "$(dirname -- "${BASH_SOURCE[0]}")/common.sh"
# Three keys of three values each: a folder for each combination, all figures in trials.json, the same call goes on, and the
# page shows missed deadlines against any of the keys, also on a telephone.
# Topics: trials, report.
command -v chromium >/dev/null || fail "chromium is not installed (cmake/packages.txt)"
out=$(mktemp -d)
trap 'rm -rf "$out"' EXIT
cd "$out"
cat >scenario.yaml <<YAML
duration: 500ms
robots: {r: {clients: {planner: {command: [$build/bin/seeded_planner, "\${seed}", "50", "0"], class: periodic, deadline: 4ms}}}}
YAML
fly() {
  "$tcsim" trials --accounting fixed --jobs 2 --trials 1 --out t --vary robots.r.cpu.speed=0.5,1,2 \
    --vary robots.r.clients.planner.deadline=4ms,6ms,8ms --vary "$@" >said 2>&1
}
cost=robots.r.clients.planner.fixed_call_cost
fly $cost=50us,100us || fail "$(cat said)"
fly $cost=50us,100us,200us || fail "$(cat said)"
grep -q '18 of 27 trials are done already' said || fail "$(cat said)"
grep -q "^robots.r.cpu.speed=2 .*deadline=8ms $cost=200us  *1 of 1" said || fail "$(cat said)"
! fly robots.r.cpu=1 || fail "a key above another one was taken"
grep -q -- '--vary robots.r.cpu and --vary robots.r.cpu.speed set the same thing' said || fail "$(cat said)"
python3 - <<'PY' || fail "$(head -60 t/trials.json)"
import itertools, json
trials = json.load(open("t/trials.json"))
assert [v["key"].split(".")[-1] for v in trials["vary"]] == ["speed", "deadline", "fixed_call_cost"], trials["vary"]
values = [v["values"] for v in trials["vary"]]
results = trials["results"]
assert len(results) == 27
assert {tuple(r["values"]) for r in results} == set(itertools.product(*values))
for result in results:
    speed, deadline, cost = result["values"]
    assert result["folder"] == f"{speed},{deadline},{cost}/seed-0001", result
    summary = json.load(open(f"t/{result['folder']}/summary.json"))
    client = summary["clients"]["r/planner"]
    measures = result["measures"]
    assert measures["r/planner.misses"] == client["deadline"]["missed"], result
    assert measures["r/planner.response_p99"] == client["response_ns"]["p99"] / 1e9, result
    assert measures["r/planner.deadline"] == int(deadline[:-2]) / 1000, result
    # 50 readings of the clock take 2.5, 5 and 10 ms.
    late = 50 * int(cost[:-2]) > 1000 * int(deadline[:-2])
    assert measures["r/planner.missed"] == (1 if late else 0), result
PY

"$tcsim" report t --out speed.html >said 2>&1 || fail "$(cat said)"
grep -q '^Missed deadlines of r/planner against robots.r.cpu.speed:$' said || fail "$(cat said)"
"$tcsim" report t --out cost.html --measure planner.misses --measure planner.response_p99 --against fixed_call_cost >said 2>&1 ||
  fail "$(cat said)"
! "$tcsim" report t --measure planner.mises >said 2>&1 || fail "a measure that nobody has was shown"
grep -q -- "--measure: there is no measure 'planner.mises'; did you mean 'r/planner.misses'?" said || fail "$(cat said)"

# As a browser shows it on a telephone.
cat >frames.html <<'HTML'
<iframe src='cost.html' width=400 height=800 style='border:0'></iframe>
HTML
python3 - <<'PY'
page = open("cost.html", encoding="utf-8").read()
open("cost.html", "w", encoding="utf-8").write(page.replace("</body>", """<script>
addEventListener('load', () => {
  const shown = [...document.querySelectorAll('figure svg')].filter(svg => svg.getBoundingClientRect().width > 0);
  parent.postMessage(JSON.stringify({
    width: document.scrollingElement.scrollWidth, window: innerWidth,
    figures: shown.map(svg => ({id: svg.closest('figure').id, texts: [...svg.querySelectorAll('text')].map(t => t.textContent),
      bands: svg.querySelectorAll('path.band').length, curves: svg.querySelectorAll('path.bold').length}))}), '*');
});
</script></body>"""))
frames = open("frames.html").read()
open("frames.html", "w").write("<script>onmessage = event => document.title = event.data</script>" + frames)
PY
timeout 200 chromium --headless=new --no-sandbox --disable-gpu --disable-dev-shm-usage --no-first-run \
  --user-data-dir="$out/browser" --window-size=1000,900 --virtual-time-budget=4000 --dump-dom "file://$out/frames.html" \
  >seen.html 2>seen.err || fail "chromium: $(tail -3 seen.err)"
python3 - <<'PY' || fail "the page is not as it should be"
import html, json, re
dom = open("seen.html", encoding="utf-8").read()
seen = json.loads(html.unescape(re.search(r"<title>(\{.*?\})</title>", dom, re.S).group(1)))
assert seen["width"] <= seen["window"] == 400, seen["width"]
misses, response = seen["figures"]
assert misses["id"] == "measure-r-planner.misses-robots.r.clients.planner.fixed_call_cost", misses["id"]
# A panel for each deadline, in it a curve for each speed; in the legend three more lines.
assert misses["bands"] == 9 and misses["curves"] == 12, (misses["bands"], misses["curves"])
for text in ("missed deadlines of r/planner [number]", "cpu.speed:", "planner.deadline = 4ms", "200us"):
    assert text in misses["texts"], misses["texts"]
assert "response time (p99) of r/planner [ms]" in response["texts"], response["texts"]
PY
