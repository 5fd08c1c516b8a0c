#!/usr/bin/env bash
source "$(dirname -- "${BASH_SOURCE[0]}")/common.sh"
# Real runs, their page, and what a browser makes of it: every figure is there, nothing is asked of
# anybody else, nothing is wider than a telephone, and the timeline shows the part that its address
# names.
# Topics: report, trials, examples.
command -v chromium >/dev/null || fail "chromium is not installed (cmake/packages.txt)"
out=$(mktemp -d)
trap 'rm -rf "$out"' EXIT
example=$build/examples/predator_prey/scenario.yaml

plan() { printf '{"name": "%s", "first_seed": 1, "trials": %s, "vary": %s}' "$2" "$3" "$4" >"$1/trials.json"; }
fly() { "$tcsim" run "$example" --out "$out/$1" "${@:2}" >>"$out/said"; }
fly tcs/seed-0001 --duration 1.5s --seed 1  # alone: its slices are compared with its real time
beside fly tcs/seed-0002 --duration 1.5s --seed 2
mkdir "$out/tcs/seed-0003"
echo 'tcsim: predator/planner cannot be started: <gone>' >"$out/tcs/seed-0003/tcsim.log"
plan "$out/tcs" 'tcs & co' 3 null
beside fly callback --duration 0.15s --sync callback
beside fly sweep/0.5s/seed-0001 --duration 0.5s --accounting fixed
beside fly sweep/1s/seed-0001 --duration 1s --accounting fixed
all_done
plan "$out/sweep" 'tcs & co' 1 '{"key": "duration", "values": ["0.5s", "1s"]}'
# Planning for 1 s is what the example does, and of 1.5 s there is time to start.
python3 - "$out/tcs/seed-0001" <<'PY' || fail "the activations of a run are not what it did"
import csv, json, sys
rows = list(csv.DictReader(open(sys.argv[1] + "/activations.csv")))
summary = json.load(open(sys.argv[1] + "/summary.json"))
plans = [row for row in rows if row["client"] == "predator/planner" and row["thread"] == "0"
         and row["cause"] == "input" and int(row["charged_ns"]) > 2e7]  # starting takes less, meeting the others too
took = [int(row["end_ns"]) - int(row["release_ns"]) for row in plans]
assert took and all(0.9e9 < ns < 1.2e9 for ns in took), took
controls = [row for row in rows if row["client"] == "prey/controller" and row["cause"] != "start"]
counted = summary["clients"]["prey/controller"]["activations"]
assert abs(len(controls) - counted) <= 1, (len(controls), counted)
for row in rows:
    assert 0 <= int(row["release_ns"]) <= int(row["start_ns"]) <= int(row["end_ns"]), row
slices = list(csv.DictReader(open(sys.argv[1] + "/dispatches.csv")))
real = [(int(s["real_start_ns"]), int(s["real_end_ns"])) for s in slices]
assert all(a <= b for a, b in real), "a slice ends before it begins"
both = [(a, b) for a, b in zip(slices, slices[1:]) if int(a["real_end_ns"]) > int(b["real_start_ns"])]
assert not both, ("two at once", both[:3])  # whether or not some was computed ahead
ran = sum(b - a for a, b in real)
computed = sum(client["host_cpu_ns"] for client in summary["clients"].values())
assert 0.9 * computed < ran <= summary["real_ns"], (computed, ran, summary["real_ns"])
PY

"$tcsim" report "$out/callback" "$out/tcs" "$out/sweep" --mark 5 --out "$out/page.html" --figures png \
  >"$out/said" || fail "$(cat "$out/said")"
for figure in paths motion timeline response-times distances distance-over-time sweep-duration; do
  [[ $(head -c 4 "$out/page-$figure.png") == $'\x89PNG' ]] || fail "there is no picture $figure"
done
(($(stat -c %s "$out/page.html") < 2000000)) || fail "the page of three seconds is large"

# The page tells what happened in it.
python3 - "$out" <<'PY'
import sys
folder = sys.argv[1]
page = open(folder + "/page.html", encoding="utf-8").read()
before = """<script>
const seen = {errors: [], refused: []};
addEventListener('error', event => seen.errors.push(String(event.message)));
addEventListener('unhandledrejection', event => seen.errors.push(String(event.reason)));
addEventListener('securitypolicyviolation', event => seen.refused.push(event.blockedURI));
console.error = console.warn = (...words) => seen.errors.push(words.join(' '));
</script>"""
after = """<script>
addEventListener('load', () => setTimeout(() => {
  const live = document.querySelector('#timeline .live');
  const shown = element => element.getBoundingClientRect().width > 0;
  seen.figures = [...document.querySelectorAll('figure')].map(figure =>
      ({id: figure.id, pictures: [...figure.querySelectorAll('svg')].filter(shown).length}));
  seen.unnamed = [...document.querySelectorAll('svg[role=img]')].filter(svg => !svg.querySelector('title')).length;
  seen.width = document.scrollingElement.scrollWidth;
  seen.window = innerWidth;
  seen.resources = performance.getEntriesByType('resource').map(entry => entry.name);
  seen.view = document.querySelector('#timeline output').textContent;
  const press = key => live.dispatchEvent(new KeyboardEvent('keydown', {key, bubbles: true, cancelable: true}));
  const text = () => document.querySelector('#timeline output').textContent;
  const views = async before => {
    for (let turn = 0; turn < 100 && text() === before; ++turn) await new Promise(done => setTimeout(done, 20));
    return text();
  };
  (async () => {
    seen.views = [];
    for (const key of ['+', '+', 'ArrowRight', '-', 'v', '0']) {
      const before = text();
      press(key);
      seen.views.push(await views(before));
    }
    const everything = text();
    live.dispatchEvent(new WheelEvent('wheel', {deltaY: -300, ctrlKey: true, clientX: 200, bubbles: true, cancelable: true}));
    seen.views.push(await views(everything));
    await new Promise(done => setTimeout(done, 400));
    seen.address = location.hash;
    parent.postMessage(JSON.stringify(seen), "*");
  })();
}, 200));
</script>"""
open(folder + "/probe.html", "w", encoding="utf-8").write(
    page.replace("<title>", before + "<title>", 1).replace("</main>", "</main>" + after, 1))
# In frames, for no window is as narrow as a telephone: whole, and the part that the address names.
open(f"{folder}/frames.html", "w").write("""<script>
const seen = {};
onmessage = event => {
  seen[event.source === frames[0] ? 'whole' : 'part'] = JSON.parse(event.data);
  if (seen.whole && seen.part) document.title = JSON.stringify(seen);
};
</script>
<iframe src='probe.html' width=400 height=800 style='border:0'></iframe>
<iframe src='probe.html#t=0.4-0.5' width=400 height=800 style='border:0'></iframe>""")
PY
timeout 400 chromium --headless=new --no-sandbox --disable-gpu --disable-dev-shm-usage --no-first-run \
  --user-data-dir="$out/browser" --window-size=1000,900 --virtual-time-budget=8000 --dump-dom "file://$out/frames.html" \
  >"$out/seen.html" 2>"$out/seen.err" || fail "chromium: $(tail -3 "$out/seen.err")"
python3 - "$out/seen.html" <<'PY' || fail "the page is not as it should be"
import html, json, re, sys
dom = open(sys.argv[1], encoding="utf-8").read()
seen = json.loads(html.unescape(re.search(r"<title>(\{.*?\})</title>", dom, re.S).group(1)))
whole, part = seen["whole"], seen["part"]
for page in whole, part:
    assert page["errors"] == [] and page["refused"] == [] and page["resources"] == [], page
    assert page["width"] <= page["window"] == 400, (page["width"], page["window"])
    assert page["unnamed"] == 0
    ids = [figure["id"] for figure in page["figures"]]
    assert ids == ["paths", "motion", "timeline", "response-times", "distances", "distance-over-time",
                   "measure-predator-controller.response_p99-duration", "sweep-duration"], ids
    assert all(figure["pictures"] == 1 for figure in page["figures"]), page["figures"]
assert whole["view"].startswith("0.000 s to 1.500 s of virtual time"), whole["view"]
assert part["view"].startswith("0.400 s to 0.500 s of virtual time"), part["view"]
slices = lambda view: int(view.split(", ")[1].split()[0])
assert 0 < slices(part["view"]) < slices(whole["view"]) / 3, (part["view"], whole["view"])
def span(view):
    return tuple(map(float, re.match(r"([0-9.]+) s to ([0-9.]+) s", view).groups()))
length = lambda view: span(view)[1] - span(view)[0]
near = lambda a, b: abs(a - b) < 0.002
closer, closest, right, back, other_axis, everything, wheel = whole["views"]
assert near(2 * length(closer), length(whole["view"])), whole["views"]
assert near(2 * length(closest), length(closer)) and near(length(right), length(closest)), whole["views"]
assert span(right)[0] > span(closest)[0] and near(length(back), length(closer)), whole["views"]
assert "of real time" in other_axis and span(everything)[0] == 0, whole["views"]
assert length(wheel) < 0.8 * length(everything), whole["views"]
assert re.fullmatch(r"#real=[0-9.]+-[0-9.]+", whole["address"]), whole["address"]
PY
page=$(cat "$out/page.html")
[[ $page == *'tcs &amp; co, seed-0003: predator/planner cannot be started: &lt;gone&gt;'* ]] || fail "the failed trial is not named"
