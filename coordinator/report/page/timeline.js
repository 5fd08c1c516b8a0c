// The zoomable timeline. It replaces the static picture, and draws the same way for any part of it.
(() => {
  'use strict';
  const figure = document.getElementById('timeline');
  if (!figure) return;
  const live = figure.querySelector('.live');
  const output = figure.querySelector('output');
  const axisButton = figure.querySelector('[data-do=axis]');

  // --- The data: see Encoded() in timeline.cc. Times are microseconds. ---------------------------

  function decode(run) {
    const {number, signed} = tcs.numbersIn(run.slices);
    // `density`: how much of a slice the row ran; 1 but for those that were made of several.
    const times = last => ({start: new Float64Array(run.count), end: new Float64Array(run.count),
                            density: new Float32Array(run.count).fill(1), last});
    const ran = (time, i) => {
      if (run.merged) time.density[i] = number() / Math.max(1, time.end[i] - time.start[i]);
    };
    run.row = new Uint16Array(run.count);
    run.virtual = times(run.virtualEnd);
    run.real = run.real ? times(run.realEnd) : null;
    let virtual = 0, real = 0;
    for (let i = 0; i < run.count; ++i) {
      run.row[i] = number();
      run.virtual.start[i] = virtual + signed();
      run.virtual.end[i] = virtual = run.virtual.start[i] + number();
      ran(run.virtual, i);
      if (!run.real) continue;
      run.real.start[i] = real += number();
      run.real.end[i] = real + number();
      ran(run.real, i);
    }
    run.dynamics = run.rows.indexOf('dynamics');
    run.misses = (run.misses || []).map(([row, released, due, ended, sentence, parts]) =>
        ({row, released, due, ended, sentence, parts: parts.map(([time, what]) => [time, run.whats[what]])}));
    return run;
  }

  const runs = [...figure.querySelectorAll('script.timeline')].map(element => decode(JSON.parse(element.textContent)));
  let hasReal = runs.every(run => run.real);
  const view = {axis: 'virtual', from: 0, to: 1};
  const last = axis => Math.max(...runs.map(run => run[axis].last), 1);
  view.to = last(view.axis);

  // --- Drawing -----------------------------------------------------------------------------------

  const TITLE = 24, ROW = 18, BETWEEN = 6, NAME_ABOVE = 15, PROGRESS = 56, RIGHT = 60;
  const LEAST_SHARE = 0.12;
  const escaped = text => text.replace(/[&<>"]/g, c => `&#${c.charCodeAt(0)};`);
  const text = (x, y, classes, content, anchor = 'start') =>
      `<text class="${classes}" x="${x}" y="${y}" text-anchor="${anchor}">${escaped(content)}</text>`;
  const percent = share => share === 0 ? '0\u00a0%' : share < 0.095 ? `${Number((share * 100).toPrecision(share < 0.01 ? 1 : 2))}\u00a0%`
      : `${Math.round(share * 100)}\u00a0%`;

  function ticks(from, to, most) {
    const power = Math.pow(10, Math.floor(Math.log10((to - from) / most)));
    const step = [1, 2, 5, 10].map(f => f * power).find(s => (to - from) / s <= most);
    const decimals = Math.max(0, -Math.floor(Math.log10(step / 1e6) + 1e-9));
    const all = [];
    for (let i = Math.ceil(from / step - 1e-9); i * step <= to + step * 1e-9; ++i) {
      all.push([i * step, (i * step / 1e6).toFixed(decimals)]);
    }
    return all;
  }

  // Per row and column the share of the time that it ran, and per row that of the whole view.
  function busy(run, columns) {
    const {start, end, density} = run[view.axis];
    const width = (view.to - view.from) / columns;
    const share = new Float32Array(run.rows.length * columns);
    const whole = new Float64Array(run.rows.length);
    let slices = 0;
    for (let i = 0; i < run.count; ++i) {
      if (end[i] < view.from || start[i] > view.to) continue;
      ++slices;
      const from = Math.max(start[i], view.from), to = Math.min(end[i], view.to);
      whole[run.row[i]] += density[i] * (to - from);
      const first = Math.min(columns - 1, Math.floor((from - view.from) / width));
      const final = Math.min(columns - 1, Math.floor((to - view.from) / width));
      for (let column = first; column <= final; ++column) {
        const left = view.from + column * width;
        const inside = density[i] * (Math.min(to, left + width) - Math.max(from, left));
        const at = run.row[i] * columns + column;
        share[at] = Math.max(1e-6, share[at] + Math.max(0, inside) / width);
      }
    }
    // Of that part of the view that the run fills.
    const length = Math.max(1, Math.min(view.to, run[view.axis].last) - view.from);
    return {share, whole: whole.map(time => time / length), slices};
  }

  function bars(share, offset, columns, x, y) {
    let path = '', height = 0;
    for (let column = 0; column <= columns; ++column) {
      const value = column < columns ? share[offset + column] : 0;
      const next = value > 0 ? Math.max(LEAST_SHARE, Math.min(1, value)) * ROW : 0;
      if (Math.abs(next - height) < 0.05) continue;
      path += path ? `H${x + column}V${(y + ROW - next).toFixed(1)}`
                   : `M${x + column} ${y + ROW}V${(y + ROW - next).toFixed(1)}`;
      height = next;
    }
    return path && `<path class="busy" d="${path}z"/>`;
  }

  // How far the world has come in the other time.
  function progress(run, x, y, scale) {
    const across = run[view.axis], up = run[view.axis === 'real' ? 'virtual' : 'real'];
    const points = [];
    let before = null;
    for (let i = 0; i < run.count; ++i) {
      if (run.dynamics >= 0 && run.row[i] !== run.dynamics) continue;
      for (const edge of ['start', 'end']) {
        const point = [across[edge][i], up[edge][i]];
        if (point[0] < view.from) {
          before = point;
          continue;
        }
        if (points.length === 0 && before) points.push(before);
        const previous = points[points.length - 1];
        if (point[0] > view.to && previous && previous[0] > view.to) return draw(points);
        // One point a column is enough; the last one stays.
        const before_that = points[points.length - 2];
        if (before_that && (point[0] - before_that[0]) * scale < 0.5) points.pop();
        points.push(point);
      }
    }
    return draw(points);

    function draw(all) {
      if (all.length < 2) return '';
      const at = time => {  // of the other time
        let i = 1;
        while (i < all.length - 1 && all[i][0] < time) ++i;
        const [a, b] = [all[i - 1], all[i]];
        const share = b[0] > a[0] ? Math.min(1, Math.max(0, (time - a[0]) / (b[0] - a[0]))) : 1;
        return a[1] + share * (b[1] - a[1]);
      };
      const low = at(view.from), high = Math.max(at(view.to), low + 1);
      const path = all.map(([a, b]) => {
        const px = x + (Math.min(view.to, Math.max(view.from, a)) - view.from) * scale;
        const value = a < view.from ? low : a > view.to ? high : b;
        return `${px.toFixed(1)} ${(y + PROGRESS * (1 - (value - low) / (high - low))).toFixed(1)}`;
      });
      const decimals = Math.max(0, Math.min(6, 2 - Math.floor(Math.log10((high - low) / 1e6))));
      const right = x + (view.to - view.from) * scale + 4;
      return `<path class="progress" d="M${path.join('L')}"/>` +
          text(right, y + 10, 'tick', (high / 1e6).toFixed(decimals)) +
          text(right, y + PROGRESS, 'tick', (low / 1e6).toFixed(decimals));
    }
  }

  let plot = {x: 0, width: 1};  // where the view is in pixels
  let places = [], rowsOf = [], cursors = [];

  // --- The moment that the page shows --------------------------------------------------------------

  // The replay of the same run, or none.
  const replayOf = run => tcs.runs.find(replay => replay.name === run.name);

  // A time of the run in the other time.
  function translated(run, time, before, after) {
    // The dynamics go on in both.
    run.steps = run.steps || Uint32Array.from({length: run.count}, (_, i) => i).filter(i => run.dynamics < 0 || run.row[i] === run.dynamics);
    const {steps} = run, {start, end} = run[before];
    let low = 0, high = steps.length;
    while (low < high) {
      const middle = (low + high) >> 1;
      if (end[steps[middle]] < time) low = middle + 1; else high = middle;
    }
    if (low === steps.length) return run[after].last;
    const i = steps[low], length = end[i] - start[i];
    const share = length > 0 ? Math.min(1, Math.max(0, (time - start[i]) / length)) : 1;
    return run[after].start[i] + share * (run[after].end[i] - run[after].start[i]);
  }

  // What the row's program wrote: a tick for each line, one a pixel.
  function said(run, name, x, y, scale) {
    const replay = replayOf(run);
    if (!replay) return '';
    let content = '', last = -1;
    for (const line of replay.said) {
      if (line.client !== name) continue;
      const time = view.axis === 'virtual' ? line.time * 1e6 : translated(run, line.time * 1e6, 'virtual', 'real');
      if (time < view.from || time > view.to) continue;
      const px = Math.round(x + (time - view.from) * scale);
      if (px === last && !line.isMark) continue;
      last = px;
      content += `<path class="said${line.isMark ? ' is-mark' : ''}" d="M${px} ${y + 1}l3 -4h-6z"><title>${escaped(line.text)}</title></path>`;
    }
    return content;
  }

  // --- Missed deadlines ----------------------------------------------------------------------------

  const told = figure.querySelector('.miss-told');
  const late = runs.flatMap(run => run.misses.map(miss => ({run, miss})));
  let chosen = -1;

  // A line where the deadline was, one for three pixels.
  function missed(run, row, x, y, scale) {
    let content = '', last = -9;
    run.misses.forEach((miss, i) => {
      if (miss.row !== row) return;
      const due = timeOf(run, miss.due);
      if (due < view.from || due > view.to) return;
      const px = x + (due - view.from) * scale, isChosen = late[chosen] && late[chosen].miss === miss;
      if (px - last < 3 && !isChosen) return;
      last = px;
      content += `<path class="miss${isChosen ? ' is-chosen' : ''}" data-run="${runs.indexOf(run)}" data-number="${i}" d="M${px.toFixed(1)} ${y - 2}V${y + ROW + 2}"><title>${escaped(miss.sentence || 'a missed deadline')}</title></path>`;
    });
    return content;
  }
  const timeOf = (run, time) => view.axis === 'virtual' ? time : translated(run, time, 'virtual', 'real');

  // Says why, moves the world there, and brings it into view.
  function choose(number) {
    chosen = number;
    const {run, miss} = late[number];
    const line = document.createElement('p'), parts = document.createElement('ul');
    line.textContent = miss.sentence ? `${miss.sentence}.` :
        `${run.rows[miss.row]} missed the deadline of what came at ${(miss.released / 1e6).toFixed(6)} s. To see why: tcsim explain DIR ${run.rows[miss.row]} --at ${(miss.due / 1e6).toFixed(6)}s`;
    parts.className = 'parts';
    for (const [time, what] of miss.parts) {
      const part = document.createElement('li'), length = document.createElement('span'), of = document.createElement('span');
      length.className = 'n';
      length.textContent = time;
      of.textContent = what;
      part.append(length, of);
      parts.append(part);
    }
    told.replaceChildren(line, parts);
    told.hidden = false;
    figure.querySelector('.misses output').textContent = `${number + 1} of ${late.length}`;
    const replay = replayOf(run);
    if (replay) {
      tcs.pause();
      tcs.chooseRun(tcs.runs.indexOf(replay));
      tcs.seek(miss.due / 1e6);
    }
    const from = timeOf(run, miss.released), to = timeOf(run, miss.ended), length = view.to - view.from;
    if (from < view.from || to > view.to) show((from + to - length) / 2, (from + to + length) / 2); else draw();
  }
  // The next one after the one that is chosen, or else after the moment that is shown.
  function nextMiss(by) {
    if (chosen >= 0) return choose((chosen + by + late.length) % late.length);
    const now = tcs.run ? tcs.time * 1e6 : 0, next = late.findIndex(({miss}) => miss.due > now);
    choose(by > 0 ? Math.max(0, next) : (next < 0 ? late.length : Math.max(1, next)) - 1);
  }
  if (late.length) {
    figure.querySelectorAll('[data-miss]').forEach(button =>
        button.addEventListener('click', () => nextMiss(button.dataset.miss === 'forth' ? 1 : -1)));
  }

  // Rows that ran since the last picture or step are lit: a controller is done in less than one.
  let lastMoment = 0;
  function showMoment() {
    if (!tcs.run) return;
    const now = tcs.time * 1e6;
    const since = lastMoment < now && now - lastMoment <= 2e5 ? lastMoment : now - 1;
    lastMoment = now;
    let row = 0;
    runs.forEach((run, i) => {
      const replay = replayOf(run), isShown = replay === tcs.run;
      const ran = isShown ? ranBetween(run, since, now) : new Set();
      run.rows.forEach((name, number) => {
        const element = rowsOf[row++];
        if (element) element.classList.toggle('is-lit', ran.has(number));
      });
      if (isShown && computing) {
        const who = run.rows.filter((name, number) => ran.has(number) && number !== run.dynamics);
        computing.textContent = who.length ? `computing: ${who.join(', ')}` : 'computing: nobody';
      }
      if (!cursors[i]) return;
      const time = view.axis === 'virtual' ? now : translated(run, now, 'virtual', 'real');
      const isInView = isShown && time >= view.from && time <= view.to;
      cursors[i].style.display = isInView ? '' : 'none';
      cursors[i].setAttribute('transform', `translate(${(plot.x + (time - view.from) / (view.to - view.from) * plot.width).toFixed(1)} 0)`);
    });
  }
  const computing = document.querySelector('#replay .computing');

  function ranBetween(run, from, to) {
    const rows = new Set(), {start, end} = run.virtual;
    if (!run.longest) {
      run.longest = 0;
      for (let i = 0; i < run.count; ++i) run.longest = Math.max(run.longest, end[i] - start[i]);
      run.order = Uint32Array.from({length: run.count}, (_, i) => i).sort((a, b) => start[a] - start[b]);
    }
    let low = 0, high = run.count;
    while (low < high) {
      const middle = (low + high) >> 1;
      if (start[run.order[middle]] < from - run.longest) low = middle + 1; else high = middle;
    }
    for (; low < run.count && start[run.order[low]] <= to; ++low) {
      const i = run.order[low];
      if (end[i] >= from && (end[i] > start[i] || start[i] > from)) rows.add(run.row[i]);
    }
    return rows;
  }

  // The run that was clicked, and the moment.
  function seekTo(event) {
    const y = event.clientY - live.getBoundingClientRect().top;
    const {run} = places.find(place => y < place.bottom) || places[places.length - 1];
    const replay = replayOf(run);
    if (!replay) return;
    const time = Math.min(view.to, Math.max(view.from, timeAt(event.clientX)));
    tcs.pause();
    tcs.chooseRun(tcs.runs.indexOf(replay));
    tcs.seek((view.axis === 'virtual' ? time : translated(run, time, 'real', 'virtual')) / 1e6);
  }
  // A mark tells of its miss; elsewhere it is the moment that counts.
  function press(event) {
    const mark = pressedOn && pressedOn.closest && pressedOn.closest('path.miss');
    if (!mark) return seekTo(event);
    const miss = runs[mark.dataset.run].misses[mark.dataset.number];
    choose(late.findIndex(each => each.miss === miss));
  }
  tcs.on(showMoment);

  function draw() {
    const width = Math.max(280, Math.floor(live.clientWidth));
    const narrow = width < 560;
    const longest = Math.max(...runs.flatMap(run => run.rows.map(name => name.length)), 12);
    const x = narrow ? 8 : Math.min(longest * 6.4, 200) + 14;
    const columns = Math.floor(width - RIGHT - x);
    const scale = columns / (view.to - view.from);
    plot = {x, width: columns};
    const other = view.axis === 'real' ? 'virtual time [s]' : 'real time [s]';
    let y = 6, content = '', slices = 0;
    const label = (name, row) => {
      if (!narrow) return text(x - 6, row + 13, 'note', name, 'end');
      return text(x, row - 4, 'note', name);
    };
    places = [];
    for (const run of runs) {
      const top = y;
      y += TITLE;
      content += text(8, y - 8, 'name', run.name);
      const ran = busy(run, columns);
      slices += ran.slices;
      run.rows.forEach((name, row) => {
        // All of virtual time is theirs.
        if (row === run.dynamics && view.axis === 'virtual') {
          content += '<g class="row"></g>';
          return;
        }
        if (narrow) y += NAME_ABOVE;
        content += `<g class="row">` + label(name, y) + `<rect class="lane" x="${x}" y="${y}" width="${columns}" height="${ROW}"/>` +
            bars(ran.share, row * columns, columns, x, y) +
            text(x + columns + 4, y + 13, 'tick', percent(ran.whole[row])) + said(run, name, x, y, scale) + missed(run, row, x, y, scale) + '</g>';
        y += ROW + BETWEEN;
      });
      places.push({run, top, bottom: y});
      // How one time passes in the other is the simulator's business.
      if (view.axis === 'virtual') {
        places[places.length - 1].bottom = y;
        content += `<path class="cursor" d="M0 ${top + TITLE - 4}V${y}"/>`;
        continue;
      }
      if (narrow) y += NAME_ABOVE;
      content += label(other, y) +
          `<rect class="lane" x="${x}" y="${y}" width="${columns}" height="${PROGRESS}"/>` +
          progress(run, x, y, scale);
      y += PROGRESS + BETWEEN;
      places[places.length - 1].bottom = y;
      content += `<path class="cursor" d="M0 ${top + TITLE - 4}V${y}"/>`;
    }
    content += `<path class="axis" d="M${x} ${y}H${x + columns}"/>`;
    for (const [at, name] of ticks(view.from, view.to, narrow ? 3 : 7)) {
      const px = (x + (at - view.from) * scale).toFixed(1);
      content += `<path class="axis" d="M${px} ${y}v4"/>` + text(px, y + 16, 'tick', name, px < 20 ? 'start' : 'middle');
    }
    content += text(x + columns, y + 33, 'tick', `${view.axis} time [s]`, 'end');
    const seconds = time => (time / 1e6).toFixed(view.to - view.from < 1e4 ? 6 : 3);
    const shown = `${seconds(view.from)} s to ${seconds(view.to)} s of ${view.axis} time, ${slices} slices`;
    live.innerHTML = `<svg viewBox="0 0 ${width} ${y + 40}" width="${width}" height="${y + 40}" role="img">` +
        `<title>${escaped(shown)}</title>${content}</svg>`;
    rowsOf = [...live.querySelectorAll('g.row')];
    cursors = [...live.querySelectorAll('path.cursor')];
    showMoment();
    output.textContent = shown;
    axisButton.textContent = view.axis === 'real' ? 'show over virtual time' : 'show over real time';
  }

  // --- A run that goes on --------------------------------------------------------------------------

  const joined = (a, b) => {
    const all = new a.constructor(a.length + b.length);
    all.set(a);
    all.set(b, a.length);
    return all;
  };
  const joinedTimes = (a, b) => b && {start: joined(a.start, b.start), end: joined(a.end, b.end), density: joined(a.density, b.density), last: b.last};
  // What the server says is new, from which slice on. From the first on it takes the place of all.
  // A few times a second is often enough for so many.
  const waiting = [];
  tcs.growTimeline = (news, from) => {
    if (waiting.push([news, from]) > 1) return;
    setTimeout(() => {
      const isAll = view.from <= 0 && view.to >= last(view.axis);
      waiting.splice(0).forEach(each => take(...each));
      if (isAll) [view.from, view.to] = [0, last(view.axis)];
      draw();
    }, 400);
  };
  function take(news, from) {
    const part = decode(news), [run] = runs;
    if (from.slices > 0) {
      part.virtual = joinedTimes(run.virtual, part.virtual);
      part.real = joinedTimes(run.real, part.real);
      part.row = joined(run.row, part.row);
      part.count += run.count;
    }
    // What was made of the slices before is made again.
    Object.assign(run, part, {steps: null, order: null, longest: 0});
    hasReal = Boolean(run.real);
    if (!hasReal) view.axis = 'virtual';
    axisButton.hidden = !hasReal;
  }

  // --- The view and its address ------------------------------------------------------------------

  const LEAST_US = 20;
  let pending = 0, naming = 0;

  function show(from, to) {
    const end = last(view.axis);
    const length = Math.min(end, Math.max(LEAST_US, to - from));
    const middle = (from + to) / 2;
    view.from = Math.min(Math.max(0, middle - length / 2), end - length);
    view.to = view.from + length;
    // Once for all events of one moment.
    if (!pending) pending = setTimeout(() => { pending = 0; draw(); }, 10);
    clearTimeout(naming);
    naming = setTimeout(nameView, 300);
  }

  function nameView() {
    const whole = view.from <= 0 && view.to >= last(view.axis);
    const key = view.axis === 'real' ? 'real' : 't';
    const hash = `#${key}=${(view.from / 1e6).toFixed(6)}-${(view.to / 1e6).toFixed(6)}`;
    if (whole && !location.hash) return;
    try {
      history.replaceState(null, '', hash);
    } catch (error) {
      // Some browsers do not let files do that; the view is there all the same.
    }
  }

  function followAddress() {
    const named = /^#(t|real)=([0-9.]+)-([0-9.]+)$/.exec(location.hash);
    if (!named) return;
    const [from, to] = [Number(named[2]) * 1e6, Number(named[3]) * 1e6];
    if (!(to > from) || (named[1] === 'real' && !hasReal)) return;
    view.axis = named[1] === 'real' ? 'real' : 'virtual';
    show(from, to);
    return true;
  }

  const zoom = (factor, at = (view.from + view.to) / 2) =>
      show(at - (at - view.from) * factor, at + (view.to - at) * factor);
  const move = share => {
    const by = (view.to - view.from) * share;
    show(view.from + by, view.to + by);
  };
  const timeAt = clientX =>
      view.from + (clientX - live.getBoundingClientRect().left - plot.x) / plot.width * (view.to - view.from);

  // The same part of the first run in the other time.
  function changeAxis() {
    if (!hasReal) return;
    const [run, before] = [runs[0], view.axis];
    const after = before === 'real' ? 'virtual' : 'real';
    const whole = view.from <= 0 && view.to >= last(before);
    const [from, to] = whole ? [0, last(after)]
        : [translated(run, view.from, before, after), translated(run, view.to, before, after)];
    view.axis = after;
    show(from, to);
  }

  const actions = {
    in: () => zoom(0.5), out: () => zoom(2), left: () => move(-0.25), right: () => move(0.25),
    whole: () => show(0, last(view.axis)), axis: changeAxis,
  };
  const keys = {'+': 'in', '=': 'in', '-': 'out', ArrowLeft: 'left', ArrowRight: 'right', '0': 'whole',
                Home: 'whole', v: 'axis'};

  figure.querySelectorAll('[data-do]').forEach(button =>
      button.addEventListener('click', () => actions[button.dataset.do]()));
  live.addEventListener('keydown', event => {
    if (!keys[event.key] || event.ctrlKey || event.metaKey || event.altKey) return;
    event.preventDefault();
    actions[keys[event.key]]();
  });
  // The wheel alone scrolls the page, unless the timeline was clicked.
  live.addEventListener('wheel', event => {
    if (!event.ctrlKey && document.activeElement !== live) return;
    event.preventDefault();
    zoom(Math.pow(1.002, event.deltaY), timeAt(event.clientX));
  }, {passive: false});
  live.addEventListener('dblclick', event => zoom(0.4, timeAt(event.clientX)));

  const fingers = new Map();
  let pressed = null;  // where, until the finger moves
  let pressedOn = null;
  live.addEventListener('pointerdown', event => {
    if (event.button !== 0) return;
    fingers.set(event.pointerId, event.clientX);
    live.setPointerCapture(event.pointerId);
    pressed = fingers.size === 1 ? event.clientX : null;
    pressedOn = event.target;
  });
  live.addEventListener('pointermove', event => {
    if (!fingers.has(event.pointerId)) return;
    const before = [...fingers.values()];
    fingers.set(event.pointerId, event.clientX);
    const after = [...fingers.values()];
    const perPixel = (view.to - view.from) / plot.width;
    if (pressed !== null && Math.abs(event.clientX - pressed) >= 4) pressed = null;
    if (fingers.size === 1) {
      show(view.from - (after[0] - before[0]) * perPixel, view.to - (after[0] - before[0]) * perPixel);
    } else if (fingers.size === 2 && Math.abs(after[0] - after[1]) > 8) {
      const factor = Math.abs(before[0] - before[1]) / Math.abs(after[0] - after[1]);
      zoom(Math.min(4, Math.max(0.25, factor)), timeAt((after[0] + after[1]) / 2));
    }
  });
  for (const over of ['pointerup', 'pointercancel']) {
    live.addEventListener(over, event => {
      fingers.delete(event.pointerId);
      if (over === 'pointerup' && pressed !== null && Math.abs(event.clientX - pressed) < 4) press(event);
      pressed = null;
    });
  }

  figure.classList.add('is-live');
  figure.querySelectorAll('.controls, .live, .hint').forEach(element => { element.hidden = false; });
  figure.querySelector('.misses').hidden = late.length === 0;
  told.hidden = true;
  axisButton.hidden = !hasReal;
  draw();
  followAddress();
  addEventListener('hashchange', () => {
    if (!followAddress()) return;
    figure.scrollIntoView({block: 'start'});
    live.focus({preventScroll: true});
  });
  tcs.onWidth(live, draw);
})();
