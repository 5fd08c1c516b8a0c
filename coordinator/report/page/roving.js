// Keys reach everything in few steps: the buttons of a toolbar are one stop of the Tab key, and arrow keys go from one
// to the next.
(() => {
  'use strict';
  const STEP = {ArrowLeft: -1, ArrowUp: -1, ArrowRight: 1, ArrowDown: 1};
  const partsOf = bar => [...bar.querySelectorAll('button, input[type=checkbox]')].filter(part => part.getClientRects().length && !part.disabled);
  // One of them is the stop: the one that had the focus last, or the first.
  function settle(bar, chosen) {
    const all = [...bar.querySelectorAll('button, input[type=checkbox]')], seen = partsOf(bar);
    const stop = seen.includes(chosen) ? chosen : seen.find(part => part.tabIndex === 0) || seen[0];
    for (const part of all) part.tabIndex = part === stop ? 0 : -1;
  }
  tcs.toolbar = bar => {
    bar.addEventListener('focusin', event => { if (event.target.matches('button, input[type=checkbox]')) settle(bar, event.target); });
    bar.addEventListener('keydown', event => {
      if (!STEP[event.key] || event.ctrlKey || event.metaKey || event.altKey || !event.target.matches('button, input[type=checkbox]')) return;
      const seen = partsOf(bar), at = seen.indexOf(event.target);
      if (at < 0) return;
      event.preventDefault();
      event.stopPropagation();
      seen[(at + STEP[event.key] + seen.length) % seen.length].focus();
    });
    tcs.settleToolbar(bar);
  };
  tcs.settleToolbar = bar => settle(bar, bar.querySelector('[tabindex="0"]'));
  document.querySelectorAll('[role=toolbar]').forEach(tcs.toolbar);
  // Parts come and go.
  addEventListener('focusin', event => {
    const bar = event.target.closest && event.target.closest('[role=toolbar]');
    if (!bar) document.querySelectorAll('[role=toolbar]').forEach(tcs.settleToolbar);
  });
  // A table is a stop only where it can be scrolled.
  const tables = [...document.querySelectorAll('.table')];
  const fit = () => tables.forEach(table => {
    if (table.scrollWidth > table.clientWidth + 1) table.tabIndex = 0; else table.removeAttribute('tabindex');
  });
  fit();
  addEventListener('resize', fit);
  addEventListener('load', () => document.querySelectorAll('[role=toolbar]').forEach(tcs.settleToolbar));
})();
