// A run that goes on: asks the server for what is new, again and again, and tells it what people want
// of the run. A page that asks late gets more at once; nobody waits for it.
(() => {
  'use strict';
  const about = JSON.parse(document.querySelector('script.live').textContent);
  const bar = document.getElementById('run');
  const how = bar.querySelector('.how');
  const control = name => bar.querySelector(`[data-run=${name}]`);
  const OFTEN = 150, HIDDEN = 1000, AGAIN = 1000;  // milliseconds
  let place = {generation: about.generation, ...about.to};
  let hasEnded = false, misses = 0;

  // --- How it goes ---------------------------------------------------------------------------------

  const seconds = ns => (ns / 1e9).toFixed(ns % 1e7 ? 3 : 2);
  let before = null, rate = null;
  let shown = '';  // what a picture is made for once only
  function show(status) {
    const all = JSON.stringify([status.stage, status.now, status.end, status.behind, status.wantsStand, status.pace, status.reports]);
    if (all === shown) return;
    shown = all;
    const of = status.end ? `${seconds(status.now)} of ${seconds(status.end)} s` : `${seconds(status.now)} s`;
    if (before && status.real > before.real && status.stage === 'goes on') {
      const now = (status.now - before.now) / (status.real - before.real);
      rate = rate === null ? now : rate * 0.7 + now * 0.3;
    }
    before = status;
    const behind = status.behind > 5e7 ? `, ${(status.behind / 1e9).toFixed(1)} s behind its pace` : '';
    const sentences = {
      'starting': 'The run is about to start.',
      'goes on': `The run goes on: ${of}${rate === null ? '' : `, ${rate.toFixed(2)} × real time`}${behind}.`,
      'stands': `The run is paused at ${of}${about.mayControl ? '' : ', by somebody else'}.`,
      'ended': `The run has ended at ${seconds(status.now)} s. ` + (status.reports ? 'Load this page again for the whole report.' :
          'To see it again: tcsim view, or tcsim report for a page to keep.'),
    };
    how.textContent = sentences[status.stage];
    bar.dataset.stage = status.stage;
    const isOver = status.stage === 'ended';
    control('stand').hidden = !about.mayControl || isOver || status.wantsStand;
    control('go').hidden = !about.mayControl || isOver || !status.wantsStand;
    bar.querySelector('.steps').hidden = bar.querySelector('.paces').hidden = !about.mayControl || isOver;
    const pace = control('pace');
    if (document.activeElement === pace) {
      shown = '';  // it is shown once nobody chooses
      return;
    }
    const value = String(status.pace);
    if (![...pace.options].some(option => option.value === value)) pace.add(new Option(`${value} ×`, value));
    pace.value = value;
  }

  // --- What is new ---------------------------------------------------------------------------------

  // Nothing is drawn again for nothing: a page of a run that is paused takes no processor.
  const hasMore = (to, than) => to.generation !== than.generation || to.moments > than.moments ||
      to.said > than.said || to.slices > than.slices;
  async function ask() {
    const asked = place, {generation, moments, said, slices} = asked;
    const answer = await fetch(`news?generation=${generation}&moments=${moments}&said=${said}&slices=${slices}`, {cache: 'no-store'});
    if (!answer.ok) throw new Error(String(answer.status));
    const news = await answer.json();
    if (place !== asked) return;  // of two that were asked at once the other one came first
    // Without a world to show so far, the page is made anew with the first one.
    if (!tcs.run && news.to.moments > 0) return location.reload();
    const next = {generation: news.generation, ...news.to};
    if (tcs.run && news.replay && hasMore(next, asked)) {
      tcs.grow(news.replay, news.from);
      tcs.growTimeline(news.timeline, news.from);
    }
    place = next;
    show(news.status);
    hasEnded = news.status.stage === 'ended';
  }
  async function askAgain() {
    try {
      await ask();
      misses = 0;
    } catch (error) {
      // The server is gone with the run, or with who has stopped it.
      if (++misses > 2) {
        how.textContent = hasEnded ? how.textContent : 'Nobody answers any more: the run has ended, or whoever showed it.';
        bar.dataset.stage = 'gone';
        bar.querySelectorAll('button, select, .steps, .paces').forEach(element => { element.hidden = true; });
        return;
      }
    }
    if (!hasEnded) setTimeout(askAgain, misses ? AGAIN : document.hidden ? HIDDEN : OFTEN);
  }

  // --- What people want ----------------------------------------------------------------------------

  async function want(words) {
    try {
      await fetch('control', {method: 'POST', headers: {'Content-Type': 'text/plain'}, body: words});
      await ask();
    } catch (error) {
      how.textContent = 'The run could not be asked for that: nobody answers.';
    }
  }
  control('stand').addEventListener('click', () => want('stand'));
  control('go').addEventListener('click', () => want('go'));
  control('step').addEventListener('click', () => { tcs.run && tcs.follow(); want(`step ${control('by').value}000000`); });
  control('pace').addEventListener('change', () => want(`pace ${control('pace').value}`));

  // --- The newest moment ---------------------------------------------------------------------------

  const following = control('follow');
  following.hidden = !tcs.run;
  if (tcs.run) {
    following.addEventListener('click', () => tcs.follow());
    tcs.on(what => { if (what === 'following') following.setAttribute('aria-pressed', String(tcs.isFollowing)); });
    tcs.follow();
  }
  askAgain();
})();
