// What programs said, in their order in time; a click on a line moves the world there.
(() => {
  'use strict';
  const list = document.getElementById('said-lines');
  if (!list || !tcs.run) return;
  const filter = document.querySelector('#said select');
  const items = [];
  let here = -1, known = 0;

  function fill() {
    items.length = 0;
    list.replaceChildren();
    here = -1;
    known = 0;
    more();
  }
  // What has come since.
  function more() {
    const chosen = filter.value;
    for (const line of tcs.run.said.slice(known)) {
      if (chosen && line.client !== chosen) continue;
      const item = document.createElement('li');
      const button = document.createElement('button');
      const parts = [['time', `${line.time.toFixed(3)}\u00a0s`], ['who', line.client], [line.isMark ? 'text mark' : `text ${line.stream}`, line.text]];
      for (const [name, content] of parts) {
        const part = document.createElement('span');
        part.className = name;
        part.textContent = content;
        button.append(part);
      }
      button.type = 'button';
      button.tabIndex = -1;  // the list is one stop
      button.addEventListener('click', () => { tcs.pause(); tcs.seek(line.time); });
      item.append(button);
      list.append(item);
      items.push({item, time: line.time});
    }
    known = tcs.run.said.length;
    show();
  }
  function fillFilter() {
    const clients = [...new Set(tcs.run.said.map(line => line.client))].sort();
    filter.replaceChildren(new Option('all programs', ''), ...clients.map(client => new Option(client, client)));
    filter.closest('.controls').hidden = clients.length < 2;
  }
  function show() {
    let last = -1;
    while (last + 1 < items.length && items[last + 1].time <= tcs.time + 1e-6) ++last;
    if (last === here) return;
    if (items[here]) items[here].item.classList.remove('is-now');
    here = last;
    if (!items[here]) return;
    items[here].item.classList.add('is-now');
    centre(3);
  }
  // Within the list alone: the page stays where it is. A line that has not been seen yet is as high as the style
  // presumes, so the lines that come into view move this one: some pictures later it is looked for again.
  function centre(turns) {
    const line = items[here];
    if (!line) return;
    const away = line.item.offsetTop - list.offsetTop - list.clientHeight / 2 + line.item.clientHeight / 2 - list.scrollTop;
    if (Math.abs(away) > 1) list.scrollTop += away;
    if (turns > 0) requestAnimationFrame(() => { if (items[here] === line) centre(turns - 1); });
  }
  // Nothing of the list has its height before somebody sees it.
  new IntersectionObserver(([seen]) => { if (seen.isIntersecting) centre(3); }).observe(list);
  // Arrow keys go from line to line.
  list.addEventListener('keydown', event => {
    if (event.ctrlKey || event.metaKey || event.altKey || !items.length) return;
    const last = items.length - 1;
    const at = items.findIndex(({item}) => item.contains(document.activeElement));
    const from = at < 0 ? Math.max(0, here) : at;
    const to = {ArrowUp: from - 1, ArrowDown: at < 0 ? from : from + 1, PageUp: from - 10, PageDown: from + 10, Home: 0, End: last}[event.key];
    if (to === undefined) return;
    event.preventDefault();
    items[Math.min(last, Math.max(0, to))].item.firstChild.focus();
  });
  filter.addEventListener('change', fill);
  tcs.on(what => {
    if (what === 'run') {
      fillFilter();
      fill();
    }
    if (what === 'time') show();
    if (what === 'grown' && tcs.run.said.length > known) {
      const chosen = filter.value;
      fillFilter();
      filter.value = chosen;
      more();
    }
  });
  fillFilter();
  fill();
  document.getElementById('said').classList.add('is-live');
})();
