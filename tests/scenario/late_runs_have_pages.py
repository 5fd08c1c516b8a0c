"""The checks of late_runs_have_pages.sh, on late.html and the run's folder in the folder that is given."""
import gzip
import json
import sys

from browser import Browser

FOLDER = sys.argv[1]
SUMMARY = json.load(open(f"{FOLDER}/late/summary.json"))
LATE = sorted((one for one in json.load(open(f"{FOLDER}/explained.json")) if one["late_ns"] > 0),
              key=lambda one: one["release_ns"] + one["deadline_ns"])
MISSED = SUMMARY["clients"]["hover/controller"]["deadline"]["missed"]
TAB, ENTER, RIGHT, DOWN = "\ue004", "\ue007", "\ue014", "\ue015"
FOCUS = """const e = document.activeElement, part = e.closest('section, nav');
    return [part ? part.id || part.tagName : '', e.tagName, e.getAttribute('aria-label') || e.title || e.textContent.trim().slice(0, 40) || (e.labels && e.labels[0] && e.labels[0].textContent) || ''];"""


def order(browser):
    headings = browser.js("return [...document.querySelectorAll('h2')].map(h => h.textContent)")
    assert headings == ["The verdict", "Who was in time", "From sensors to actuators", "Why the worst was late", "The world",
                        "Where the robots went", "What a robot did over time", "What programs said", "Who ran when",
                        "Response times against deadlines", "Of the simulation itself"], headings
    said = browser.js("return [...document.querySelectorAll('#verdict li')].map(li => li.textContent)")
    assert said == [sentence + "." for sentence in SUMMARY["verdict"]], said
    worst = browser.js("return document.querySelector('.explained p').textContent")
    assert max(LATE, key=lambda one: one["late_ns"])["sentence"] in worst, worst
    robots = browser.js("return [...document.querySelectorAll('section:not(#simulation)')].map(s => s.innerText).join(' ')").lower()
    assert not [word for word in ("drift", "staleness", "overhead", "stolen", "Δ") if word in robots], "the simulator's figures"


def misses(browser):
    """Each is marked, and says what `tcsim explain` says."""
    assert MISSED == len(LATE) > 20, (MISSED, len(LATE))
    marks = browser.js("return document.querySelectorAll('#timeline .live path.miss').length")
    assert 0 < marks <= MISSED, marks
    browser.js("document.querySelector('[data-miss=forth]').focus()")
    for number in range(2):
        browser.keys(ENTER)
        told = browser.after_pictures("return document.querySelector('.miss-told').innerText")
        assert told.startswith(LATE[number]["sentence"]), (told, LATE[number])
        due = (LATE[number]["release_ns"] + LATE[number]["deadline_ns"]) / 1e9
        assert abs(browser.js("return tcs.time") - due) < 1e-5, due
    assert browser.js("return document.querySelector('.misses output').textContent") == f"2 of {MISSED}"
    # The links of the worst ones open the timeline there.
    browser.js("document.querySelector('.explained a').click()")
    for _ in range(100):  # it draws a moment later
        shown = browser.after_pictures("return document.querySelector('#timeline output').textContent")
        first, last = (float(word) for word in shown.replace(" s to ", " ").split()[:2])
        if last - first < 1:
            break
    worst = max(LATE, key=lambda one: one["late_ns"])
    assert first <= worst["release_ns"] / 1e9 and last >= worst["end_ns"] / 1e9 and last - first < 1, shown


def curves(browser):
    def lines():
        return browser.js("return document.querySelectorAll('#motion .live path.line').length")
    before = lines()
    browser.js("document.querySelector('.signals summary').click(); document.querySelector('.signals input').click()")
    assert lines() == before - 1, (before, lines())
    browser.js("document.querySelector('.signals input').click()")
    assert lines() == before
    axis = "return [...document.querySelectorAll('#motion .live svg > text.tick[text-anchor=middle]')].map(t => Number(t.textContent))"
    browser.js("document.querySelector('#motion .live').focus({preventScroll: true})")
    whole = browser.js(axis)
    browser.keys("+", "+")
    zoomed = browser.js(axis)
    assert whole[-1] == 2 and zoomed[-1] - zoomed[0] < 0.6, (whole, zoomed)
    browser.keys("0")
    assert browser.js(axis) == whole


def keys_alone(browser):
    browser.open(f"{FOLDER}/late.html")
    browser.after_pictures()
    stops = []
    for _ in range(80):
        browser.keys(TAB)
        stop = browser.js(FOCUS)
        if stop[1] == "BODY" or stops[:1] == [stop]:
            break
        assert stop[2], f"a stop without a name: {stop}"
        stops.append(stop)
    assert 15 < len(stops) <= 30, (len(stops), stops)
    reached = {stop[0] for stop in stops}
    assert {"why", "world", "about-motion", "said", "about-timeline"} <= reached, stops
    # A toolbar's arrows go on within it; so do those of the list of lines.
    browser.js("document.querySelector('[data-do=in]').focus()")
    browser.keys(RIGHT)
    assert browser.js("return document.activeElement.dataset.do") == "out"
    browser.js("document.querySelector('#said-lines').focus()")
    browser.keys(DOWN, DOWN, ENTER)
    line = browser.js("return document.activeElement.querySelector('.text').textContent")
    assert line == "line 1", line


def everywhere(browser):
    browser.resize(400, 800, mobile=True)
    browser.open(f"{FOLDER}/late.html")
    browser.after_pictures()
    assert browser.js("return document.scrollingElement.scrollWidth") == 400
    browser.resize(1440, 900)
    browser.after_pictures()
    # The whole width is used.
    assert browser.js("return document.querySelector('#timeline .live').clientWidth") > 1100
    browser.media("print")
    shown = browser.js("""const is = selector => [...document.querySelectorAll(selector)].some(e => e.getBoundingClientRect().height > 0);
        return [is('#verdict'), is('.contents'), is('#timeline > svg.wide path.miss'), is('#response-times path.deadline')];""")
    assert shown == [True, False, True, True], shown
    browser.media()


def trace():
    with gzip.open(f"{FOLDER}/late/trace.json.gz") as file:
        events = json.load(file)["traceEvents"]
    marked = [event for event in events if event.get("ph") == "i" and event["name"].startswith("missed deadline: ")]
    assert [event["name"] for event in sorted(marked, key=lambda event: event["ts"])] == \
        ["missed deadline: " + one["sentence"] for one in LATE], marked[:3]


def main():
    trace()
    with Browser(FOLDER) as browser:
        browser.resize(1440, 900)
        browser.open(f"{FOLDER}/late.html")
        browser.after_pictures()
        for check in (order, misses, curves, keys_alone, everywhere):
            check(browser)
            print(check.__name__, flush=True)
        complaints = browser.complaints()
        assert not complaints, complaints


main()
