// What the robots did: their ways from above and from the side, and what is known of the robot that is
// looked at, over time. It replaces the static pictures.
(() => {
  'use strict';
  if (!tcs.run || !tcs.run.count) return;
  const escaped = text => text.replace(/[&<>"]/g, c => `&#${c.charCodeAt(0)};`);
  const text = (x, y, classes, content, anchor = 'start') =>
      `<text class="${classes}" x="${x.toFixed(1)}" y="${y.toFixed(1)}" text-anchor="${anchor}">${escaped(content)}</text>`;

  function ticks(from, to, most) {
    const power = Math.pow(10, Math.floor(Math.log10((to - from) / most)));
    const step = [1, 2, 5, 10].map(f => f * power).find(s => (to - from) / s <= most);
    const decimals = Math.max(0, -Math.floor(Math.log10(step) + 1e-9));
    const all = [];
    for (let i = Math.ceil(from / step - 1e-9); i * step <= to + step * 1e-9; ++i) {
      all.push([i * step, (Math.abs(i * step) < step / 2 ? 0 : i * step).toFixed(decimals)]);
    }
    return all;
  }

  function goLive(figure) {
    figure.classList.add('is-live');
    figure.querySelectorAll('.live, .hint, .controls').forEach(element => { element.hidden = false; });
    return figure.querySelector('.live');
  }

  // --- From above and from the side ----------------------------------------------------------------

  const paths = document.getElementById('paths');
  const pathsLive = paths && goLive(paths);
  let dots = [];

  // The part of the world that the robots were in, and a little more.
  function spanOf(run, axis) {
    let least = Infinity, most = -Infinity;
    for (const robot of run.robots) {
      for (const path of robot.paths) {
        const {count, poses} = run.tracks[path];
        for (let i = 0; i < count; ++i) {
          least = Math.min(least, poses[7 * i + axis]);
          most = Math.max(most, poses[7 * i + axis]);
        }
      }
    }
    return [least, most];
  }

  function drawView(run, [across, up], title, x, y, width, height, scale) {
    const spans = [spanOf(run, across), spanOf(run, up)];
    const middles = spans.map(([least, most]) => (least + most) / 2);
    const at = pose => [x + width / 2 + (pose[across] - middles[0]) * scale, y + height / 2 - (pose[up] - middles[1]) * scale];
    let content = `<rect class="lane" x="${x}" y="${y}" width="${width}" height="${height}"/>`;
    const from = middles.map((middle, i) => middle - (i ? height : width) / 2 / scale);
    const to = middles.map((middle, i) => middle + (i ? height : width) / 2 / scale);
    for (const [value, label] of ticks(from[0], to[0], Math.max(2, width / 90))) {
      const px = x + (value - from[0]) * scale;
      content += `<path class="grid" d="M${px.toFixed(1)} ${y}v${height}"/>` + text(px, y + height + 14, 'tick', label, 'middle');
    }
    for (const [value, label] of ticks(from[1], to[1], Math.max(2, height / 50))) {
      const py = y + height - (value - from[1]) * scale;
      content += `<path class="grid" d="M${x} ${py.toFixed(1)}h${width}"/>` + text(x - 5, py + 4, 'tick', label, 'end');
    }
    content += text(x, y - 7, 'name', title);
    const markers = [];
    run.robots.forEach((robot, i) => {
      for (const path of robot.paths) {
        const {count, poses} = run.tracks[path], stride = Math.max(1, Math.floor(count / 500));
        const points = [];
        for (let k = 0; k < count; k += stride) points.push(at(poses.subarray(7 * k, 7 * k + 7)).map(p => p.toFixed(1)).join(' '));
        content += `<path class="${i === tcs.robot || run.robots.length === 1 ? 'line' : 'thin'} ${tcs.colourOf(i)}" d="M${points.join('L')}"/>`;
        markers.push({path, robot: i, at});
      }
    });
    for (const {robot} of markers) {
      content += `<circle class="now f${robot % tcs.COLOURS}" r="${run.robots.length > 8 ? 3.5 : 5}"><title>${escaped(run.robots[robot].name)}</title></circle>`;
    }
    return {content, markers};
  }

  function drawPaths() {
    if (!pathsLive) return;
    const {run} = tcs, width = Math.max(280, Math.floor(pathsLive.clientWidth)), narrow = width < 560;
    const left = 40, right = 8, top = 26, bottom = 22, between = 60;
    const sizes = [0, 1, 2].map(axis => spanOf(run, axis)).map(([least, most]) => Math.max(most - least, 1e-3));
    const most = Math.max(...sizes), [wide, deep, tall] = sizes.map(size => Math.max(size, most * 0.3) * 1.12);
    const plot = narrow ? width - left - right : (width - left - right - between) / 2;
    const scale = Math.min(plot / wide, (narrow ? 320 : 380) / Math.max(deep, tall));
    const heights = [deep, tall].map(size => Math.max(70, Math.round(size * scale)));
    const above = drawView(run, [0, 1], 'from above: y [m] over x [m]', left, top, plot, heights[0], scale);
    const aside = narrow
        ? drawView(run, [0, 2], 'from the side: z [m] over x [m]', left, top + heights[0] + bottom + 34, plot, heights[1], scale)
        : drawView(run, [0, 2], 'from the side: z [m] over x [m]', left + plot + between, top, plot, heights[1], scale);
    const height = narrow ? top + heights[0] + heights[1] + 2 * bottom + 34 : top + Math.max(...heights) + bottom;
    pathsLive.innerHTML = `<svg viewBox="0 0 ${width} ${height}" width="${width}" height="${height}" role="img">` +
        `<title>Where the robots went, from above and from the side</title>${above.content}${aside.content}</svg>`;
    const circles = [...pathsLive.querySelectorAll('circle.now')];
    dots = [...above.markers, ...aside.markers].map((marker, i) => ({...marker, circle: circles[i]}));
    circles.forEach((circle, i) => circle.addEventListener('click', () => tcs.chooseRobot(dots[i].robot)));
    moveDots();
  }
  function moveDots() {
    for (const {path, at, circle} of dots) {
      const [x, y] = at(tcs.poseAt(tcs.run, path, tcs.time));
      circle.setAttribute('cx', x.toFixed(1));
      circle.setAttribute('cy', y.toFixed(1));
    }
  }

  // --- Over time -----------------------------------------------------------------------------------

  const motion = document.getElementById('motion');
  const motionLive = motion && goLive(motion);
  const chooser = motion && motion.querySelector('select');
  let panels = [], plot = {x: 0, width: 1, from: 0, to: 1};
  // The part that is shown; null: all there is. Signals that nobody wants to see, as 'panel\nline'.
  let view = null;
  const hidden = new Set();
  const keyOf = (panel, line) => `${panel.title}\n${line.name}`;

  // Roll, pitch and yaw in degrees, without jumps by a whole turn.
  function anglesOf(track) {
    const angles = [[], [], []], last = [0, 0, 0];
    for (let i = 0; i < track.count; ++i) {
      const [x, y, z, w] = track.poses.subarray(7 * i + 3, 7 * i + 7);
      const now = [Math.atan2(2 * (w * x + y * z), 1 - 2 * (x * x + y * y)),
                   Math.asin(Math.min(1, Math.max(-1, 2 * (w * y - z * x)))),
                   Math.atan2(2 * (w * z + x * y), 1 - 2 * (y * y + z * z))];
      now.forEach((angle, axis) => {
        const turns = i ? Math.round((last[axis] - angle) / (2 * Math.PI)) : 0;
        last[axis] = angle + turns * 2 * Math.PI;
        angles[axis].push(last[axis] * 180 / Math.PI);
      });
    }
    return angles;
  }

  function panelsOf(run, number) {
    const robot = run.robots[number], all = [];
    const track = run.tracks[robot.root];
    if (track.count > 1) {
      const along = axis => Array.from({length: track.count}, (_, i) => track.poses[7 * i + axis]);
      all.push({title: 'position [m]', lines: ['x', 'y', 'z'].map((name, axis) => ({name, first: 0, values: along(axis)}))});
      const angles = anglesOf(track);
      all.push({title: 'orientation [°]', lines: ['roll', 'pitch', 'yaw'].map((name, axis) => ({name, first: 0, values: angles[axis]}))});
    }
    for (const signal of run.signals) {
      if (signal.robot !== number || (track.count < 2 && signal.panel.startsWith('velocity'))) continue;
      const panel = all.find(each => each.title === signal.panel);
      if (panel) panel.lines.push(signal); else all.push({title: signal.panel, lines: [signal]});
    }
    return all;
  }

  // The numbers of a line's values between two times, and one more at each side.
  function partOf(run, line, from, to) {
    const after = time => {
      let low = 0, high = line.values.length;
      while (low < high) {
        const middle = (low + high) >> 1;
        if (run.time[line.first + middle] < time) low = middle + 1; else high = middle;
      }
      return low;
    };
    return [Math.max(0, after(from) - 1), Math.min(line.values.length, after(to) + 1)];
  }
  function pathOf(run, line, at, columns, [begin, end]) {
    const stride = Math.max(1, Math.floor((end - begin) / columns / 2));
    let path = '';
    for (let i = begin; i < end; i += stride) {
      // Of the values of a column both the least and the most.
      let least = i, most = i;
      for (let k = i + 1; k < Math.min(i + stride, end); ++k) {
        if (line.values[k] < line.values[least]) least = k;
        if (line.values[k] > line.values[most]) most = k;
      }
      for (const k of stride === 1 ? [i] : [Math.min(least, most), Math.max(least, most)]) {
        const [x, y] = at(run.time[line.first + k], line.values[k]);
        path += `${path ? 'L' : 'M'}${x.toFixed(1)} ${y.toFixed(1)}`;
      }
    }
    return path;
  }

  const MOST_LINES = 14, PANEL = 92, ABOVE = 30, ROW = 16;
  const pen = document.createElement('canvas').getContext('2d');
  function widthOf(words, weight) {
    pen.font = `${weight} 12px ${getComputedStyle(document.body).fontFamily}`;
    return pen.measureText(words).width;
  }
  // The names of a panel's lines, in as many rows as they need. Each row is a list of [name, number of the line].
  function rowsOf(names, room, withValues) {
    const rows = [[]];
    let used = 0;
    names.forEach((name, i) => {
      const needed = 9 + widthOf(name, 400) + (withValues ? 4 + widthOf('-0.00', 400) : 0);
      if (used + needed > room && rows.at(-1).length) {
        rows.push([]);
        used = 0;
      }
      rows.at(-1).push([name, i]);
      used += needed;
    });
    return rows;
  }
  function drawMotion() {
    if (!motionLive) return;
    const {run} = tcs, width = Math.max(280, Math.floor(motionLive.clientWidth)), narrow = width < 560;
    const left = 48, columns = width - left - 12;
    const {from, to} = view || {from: 0, to: run.end || 1e-3};  // at the start there is one moment alone
    plot = {x: left, width: columns, from, to};
    const scale = columns / (to - from);
    let y = 0, content = '', top = ABOVE;
    // What is 0 all the time needs no picture.
    const isZero = panel => panel.lines.every(line => line.values.every(value => Math.abs(value) < 1e-6));
    const all = panelsOf(run, tcs.robot), zero = all.filter(isZero);
    offerSignals(all.filter(panel => !isZero(panel)));
    panels = all.filter(panel => !isZero(panel))
        .map(panel => ({...panel, lines: panel.lines.map((line, colour) => ({...line, colour})).filter(line => !hidden.has(keyOf(panel, line)))}))
        .filter(panel => panel.lines.length);
    content += `<clipPath id="motion-clip"><rect x="${left}" y="0" width="${columns}" height="100000"/></clipPath>`;
    for (const panel of panels) {
      const shown = panel.lines.slice(0, MOST_LINES);
      const names = shown.map(line => line.name), withValues = !narrow && panel.lines.length <= 6;
      if (panel.lines.length > MOST_LINES) names.push(`and ${panel.lines.length - MOST_LINES} more`);
      // Beside the title, or below it where they would lie on it.
      let rows = rowsOf(names, columns - widthOf(panel.title, 600) - 12, withValues);
      const below = rows.length > 1;
      if (below) rows = rowsOf(names, columns, withValues);
      const titleAt = y + ABOVE - 8;
      y += ABOVE + (below ? ROW * rows.length : 0);
      if (panel === panels[0]) top = y;
      let least = Infinity, most = -Infinity;
      for (const line of shown) {
        const [begin, end] = partOf(run, line, from, to);
        for (let i = begin; i < end; ++i) {
          least = Math.min(least, line.values[i]);
          most = Math.max(most, line.values[i]);
        }
      }
      if (most < least) [least, most] = [0, 0];
      if (most - least < 1e-6) [least, most] = [least - 0.5, most + 0.5];
      const room = (most - least) * 0.06;
      [least, most] = [least - room, most + room];
      const at = (time, value) => [left + (time - from) * scale, y + PANEL * (1 - (value - least) / (most - least))];
      content += text(left, titleAt, 'name', panel.title);
      panel.readings = [];
      content += `<rect class="lane" x="${left}" y="${y}" width="${columns}" height="${PANEL}"/>`;
      for (const [value, label] of ticks(least, most, 4)) {
        const py = at(from, value)[1];
        content += `<path class="grid" d="M${left} ${py.toFixed(1)}h${columns}"/>` + text(left - 6, py + 4, 'tick', label, 'end');
      }
      shown.forEach(line => {
        content += `<path class="line s${line.colour % tcs.COLOURS}" clip-path="url(#motion-clip)" d="${pathOf(run, line, at, columns, partOf(run, line, from, to))}"/>`;
      });
      const legend = rows.map((row, k) => `<text x="${width - 12}" y="${y - 8 - ROW * (rows.length - 1 - k)}" text-anchor="end">` +
          row.map(([name, i], place) => i < shown.length ?
              `<tspan class="t${shown[i].colour % tcs.COLOURS}" dx="${place ? 9 : 0}">${escaped(name)}</tspan><tspan class="value" dx="4"></tspan>` :
              `<tspan dx="${place ? 9 : 0}">${name}</tspan>`).join('') + '</text>');
      content += `<g class="legend">${legend.join('')}</g>`;
      y += PANEL;
    }
    if (panels.length === 0) {
      motionLive.innerHTML = `<p class="nothing">${hidden.size ? 'No signal is chosen.' : 'It does not move, has no joints, and nothing is commanded of it.'}</p>`;
      return;
    }
    content += `<path class="axis" d="M${left} ${y}h${columns}"/>`;
    for (const [value, label] of ticks(from, to, narrow ? 4 : 9)) {
      const px = left + (value - from) * scale;
      content += `<path class="axis" d="M${px.toFixed(1)} ${y}v4"/>` + text(px, y + 17, 'tick', label, px < left + 8 ? 'start' : 'middle');
    }
    content += text(left + columns, y + 33, 'tick', 'virtual time [s]', 'end');
    for (const line of run.said) {
      if (line.isMark && line.time >= from && line.time <= to) content += `<path class="mark" d="M${(left + (line.time - from) * scale).toFixed(1)} ${top}V${y}"><title>${escaped(line.text)}</title></path>`;
    }
    if (zero.length) {
      content += text(left, y + 46, 'tick', `Always 0: ${zero.map(panel => panel.title.replace(/ \[.*/, '')).join(', ')}.`);
    }
    content += `<path class="cursor" d="M0 ${top - 4}V${y}"/>`;
    const height = y + (zero.length ? 54 : 40);
    motionLive.innerHTML = `<svg viewBox="0 0 ${width} ${height}" width="${width}" height="${height}" role="img">` +
        `<title>What is known of ${escaped(run.robots[tcs.robot].name)} over time</title>${content}</svg>`;
    const legends = [...motionLive.querySelectorAll('.legend')];
    panels.forEach((panel, i) => { panel.readings = [...legends[i].querySelectorAll('.value')]; });
    moveCursor();
  }
  const digits = value => Math.abs(value) < 0.005 ? '0.00' : Math.abs(value) >= 99.95 ? value.toFixed(0) : Math.abs(value) >= 9.995 ? value.toFixed(1) : value.toFixed(2);
  function moveCursor() {
    const cursor = motionLive && motionLive.querySelector('.cursor');
    if (!cursor) return;
    const share = (tcs.time - plot.from) / (plot.to - plot.from);
    cursor.style.display = share >= -1e-9 && share <= 1 + 1e-9 ? '' : 'none';
    cursor.setAttribute('transform', `translate(${(plot.x + plot.width * Math.min(1, Math.max(0, share))).toFixed(1)} 0)`);
    const moment = tcs.momentAt(tcs.run, tcs.time), wide = motionLive.clientWidth >= 560;
    for (const panel of panels) {
      panel.readings.forEach((reading, i) => {
        const {first, values} = panel.lines[i];
        reading.textContent = wide && panel.lines.length <= 6 && moment >= first && moment - first < values.length ? digits(values[moment - first]) : '';
      });
    }
  }

  function seekTo(event) {
    const svg = motionLive.querySelector('svg');
    if (!svg) return;
    tcs.seek((event.clientX - svg.getBoundingClientRect().left - plot.x) / plot.width * (plot.to - plot.from) + plot.from);
  }
  // A box for each signal, in groups as they are drawn.
  let offered = '';
  function offerSignals(all) {
    const list = motion.querySelector('.signals');
    const names = all.flatMap(panel => panel.lines.map(line => keyOf(panel, line))).join('\n\n');
    if (names === offered) return;
    offered = names;
    list.hidden = names === '';
    const bar = list.querySelector('[role=toolbar]');
    bar.replaceChildren(...all.map(panel => {
      const group = document.createElement('fieldset'), legend = document.createElement('legend');
      legend.textContent = panel.title;
      group.append(legend, ...panel.lines.map(line => {
        const label = document.createElement('label'), box = document.createElement('input');
        box.type = 'checkbox';
        box.checked = !hidden.has(keyOf(panel, line));
        box.addEventListener('change', () => {
          if (box.checked) hidden.delete(keyOf(panel, line)); else hidden.add(keyOf(panel, line));
          drawMotion();
        });
        label.append(box, ` ${line.name}`);
        return label;
      }));
      return group;
    }));
    if (tcs.settleToolbar) tcs.settleToolbar(bar);
  }
  function show(from, to) {
    const length = Math.min(tcs.run.end, Math.max(1e-4, to - from)), middle = (from + to) / 2;
    from = Math.min(Math.max(0, middle - length / 2), tcs.run.end - length);
    view = length >= tcs.run.end ? null : {from, to: from + length};
    drawMotion();
  }
  // Around the moment that is shown, as far as it is in view.
  const zoom = (factor, around = tcs.time) => {
    const {from, to} = plot, at = Math.min(to, Math.max(from, around));
    show(at - (at - from) * factor, at + (to - at) * factor);
  };
  const move = share => show(plot.from + (plot.to - plot.from) * share, plot.to + (plot.to - plot.from) * share);
  const zooms = {in: () => zoom(0.5), out: () => zoom(2), left: () => move(-0.25), right: () => move(0.25), whole: () => show(0, tcs.run.end)};
  if (motionLive) {
    motion.querySelectorAll('[data-zoom]').forEach(button => button.addEventListener('click', () => zooms[button.dataset.zoom]()));
    const timeAt = event => plot.from + (event.clientX - motionLive.getBoundingClientRect().left - plot.x) / plot.width * (plot.to - plot.from);
    // The wheel alone scrolls the page, unless the curves were clicked.
    motionLive.addEventListener('wheel', event => {
      if (!event.ctrlKey && document.activeElement !== motionLive) return;
      event.preventDefault();
      zoom(Math.pow(1.002, event.deltaY), timeAt(event));
    }, {passive: false});
    motionLive.addEventListener('pointerdown', event => {
      if (event.button !== 0) return;
      tcs.pause();
      motionLive.setPointerCapture(event.pointerId);
      seekTo(event);
    });
    motionLive.addEventListener('pointermove', event => { if (event.buttons & 1) seekTo(event); });
    motionLive.addEventListener('keydown', event => {
      const how = {'+': 'in', '=': 'in', '-': 'out', '0': 'whole'}[event.key];
      if (how && !event.ctrlKey && !event.metaKey && !event.altKey) {
        event.preventDefault();
        zooms[how]();
        return;
      }
      const by = {ArrowLeft: -1, ArrowRight: 1}[event.key];
      if (!by) return;
      event.preventDefault();
      tcs.step(by);
    });
    tcs.onWidth(motionLive, drawMotion);
  }
  if (pathsLive) tcs.onWidth(pathsLive, drawPaths);
  function fillChooser() {
    if (!chooser) return;
    chooser.replaceChildren(...tcs.run.robots.map((robot, i) => new Option(robot.name, i)));
    chooser.closest('label').hidden = tcs.run.robots.length < 2;
    chooser.value = String(tcs.robot);
  }
  if (chooser) chooser.addEventListener('change', () => tcs.chooseRobot(Number(chooser.value)));

  // What takes longer is not drawn for each moment that comes.
  let pending = 0;
  function drawLater() {
    if (!pending) pending = setTimeout(() => { pending = 0; drawPaths(); drawMotion(); }, 400);
  }

  tcs.on(what => {
    if (what === 'grown') drawLater();
    if (what === 'time') {
      moveDots();
      moveCursor();
    }
    if (what === 'run') fillChooser();
    if (what === 'run') view = null;
    if (what === 'robot' || what === 'run') {
      if (chooser) chooser.value = String(tcs.robot);
      drawPaths();
      drawMotion();
    }
  });
  fillChooser();
  drawPaths();
  drawMotion();
})();
