// The bar with the time: play, step, speed, and the flags of what programs said.
(() => {
  'use strict';
  const player = document.getElementById('player');
  if (!player || !tcs.run) return;
  const slider = player.querySelector('input');
  const output = player.querySelector('output');
  const flags = player.querySelector('.flags');
  const speeds = player.querySelector('select');
  const toggle = player.querySelector('[data-play=toggle]');
  const SPEEDS = [0.01, 0.05, 0.1, 0.25, 0.5, 1, 2, 5, 10];

  for (const speed of SPEEDS) speeds.add(new Option(`${speed}\u00a0×`, speed, false, speed === 1));
  speeds.value = '1';

  function showTime() {
    slider.value = tcs.time;
    const {end} = tcs.run;
    const decimals = end < 1 ? 4 : 2;
    output.textContent = `${tcs.time.toFixed(decimals)}\u00a0/\u00a0${end.toFixed(decimals)}\u00a0s`;
    slider.setAttribute('aria-valuetext', `${tcs.time.toFixed(decimals)} seconds`);
    slider.style.setProperty('--done', `${100 * tcs.time / end}%`);
  }
  // One flag a pixel is enough; marks have them all.
  function showFlags() {
    let content = '', last = -1;
    for (const line of tcs.run.said) {
      const share = line.time / (tcs.run.end || 1);
      if (!line.isMark && share - last < 0.004) continue;
      if (!line.isMark) last = share;
      content += `<i class="${line.isMark ? 'mark' : ''}" style="left:${(100 * share).toFixed(2)}%"></i>`;
    }
    flags.innerHTML = content;
  }
  function showRun() {
    slider.max = tcs.run.end;
    showFlags();
    showTime();
  }

  const actions = {
    start: () => { tcs.pause(); tcs.seek(0); },
    end: () => { tcs.pause(); tcs.seek(tcs.run.end); },
    back: () => tcs.step(-1), forth: () => tcs.step(1), toggle: tcs.toggle,
    secondBack: () => tcs.seek(tcs.time - 1), secondForth: () => tcs.seek(tcs.time + 1),
    slower: () => change(-1), faster: () => change(1),
  };
  function change(by) {
    const now = SPEEDS.indexOf(tcs.speed);
    tcs.setSpeed(SPEEDS[Math.min(SPEEDS.length - 1, Math.max(0, now + by))]);
  }
  const keys = {' ': 'toggle', k: 'toggle', ',': 'back', '.': 'forth', j: 'secondBack', l: 'secondForth',
                '<': 'slower', '>': 'faster', Home: 'start', End: 'end'};

  player.querySelectorAll('button').forEach(button =>
      button.addEventListener('click', () => actions[button.dataset.play]()));
  speeds.addEventListener('change', () => tcs.setSpeed(Number(speeds.value)));
  slider.addEventListener('input', () => { tcs.pause(); tcs.seek(Number(slider.value)); });
  slider.addEventListener('keydown', event => {
    const by = {ArrowLeft: -1, ArrowDown: -1, ArrowRight: 1, ArrowUp: 1, PageDown: -10, PageUp: 10}[event.key];
    if (!by || event.altKey || event.ctrlKey || event.metaKey) return;
    event.preventDefault();
    tcs.step(by);
  });
  // Wherever the reader is, unless a control takes the key for itself.
  document.addEventListener('keydown', event => {
    if (event.ctrlKey || event.metaKey || event.altKey || event.defaultPrevented) return;
    if (event.target.closest('select, textarea, .live, .run')) return;
    if (event.key === ' ' && event.target.closest('button, input[type=checkbox], summary, a')) return;
    if (!keys[event.key]) return;
    event.preventDefault();
    actions[keys[event.key]]();
  });

  tcs.on(what => {
    if (what === 'time') showTime();
    if (what === 'run' || what === 'grown') showRun();
    if (what !== 'playing') return;
    toggle.classList.toggle('is-playing', tcs.isPlaying);
    toggle.title = tcs.isPlaying ? 'Pause (space)' : 'Play (space)';
    speeds.value = String(tcs.speed);
  });
  player.hidden = false;
  showRun();
})();
