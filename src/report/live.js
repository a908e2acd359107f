'use strict';
// Asks for the status every second and changes what is new in the page. Text from the status never
// becomes markup.
const at = (id) => document.getElementById(id);
const write = (element, text) => {
  if (element.textContent !== text) element.textContent = text;
};
const grouped = (n) => String(n).replace(/\B(?=(\d{3})+$)/g, ',');
const unit = (n) => {
  if (n >= 999.5e6) return (n / 1e9).toFixed(1) + ' G';
  if (n >= 999.5e3) return (n / 1e6).toFixed(1) + ' M';
  if (n >= 999.5) return (n / 1e3).toFixed(0) + ' k';
  return n.toFixed(0);
};
const span = (s) => {
  const whole = Math.round(s);
  if (whole < 60) return whole + ' s';
  if (whole < 3600) return Math.floor(whole / 60) + ' min ' + whole % 60 + ' s';
  return Math.floor(whole / 3600) + ' h ' + Math.floor(whole % 3600 / 60) + ' min';
};
const bytes = (n) =>
  n >= 2 ** 30 ? (n / 2 ** 30).toFixed(1) + ' GiB' : Math.floor(n / 2 ** 20) + ' MiB';
const width = (element, share) => {
  const text = (100 * Math.min(1, Math.max(0, share))).toFixed(2) + '%';
  if (element.style.width !== text) element.style.width = text;
};

// Makes a row of each item: rows that are there stay.
function fill(parent, items, make, show) {
  while (parent.children.length > items.length) parent.lastElementChild.remove();
  while (parent.children.length < items.length) parent.append(make());
  items.forEach((item, i) => show(parent.children[i], item));
}

function make_stage() {
  const row = document.createElement('div');
  row.className = 'stage';
  row.innerHTML = '<span></span><div class="bar"><i></i></div><span></span>';
  return row;
}

function show_stage(row, stage) {
  write(row.firstElementChild, stage.stage);
  width(row.querySelector('i'), stage.known ? stage.done / stage.known : 0);
  write(row.lastElementChild, grouped(stage.done) + ' of ' + grouped(stage.known));
}

function make_worker() {
  const row = document.createElement('tr');
  row.innerHTML = '<td></td><td></td><td><div class="bar"><i></i><i class="held"></i></div></td>' +
    '<td></td>'.repeat(5);
  return row;
}

function show_worker(most) {
  return (row, w) => {
    const cells = row.children;
    write(cells[0], String(w.worker));
    write(cells[1], w.host + ':' + w.pid);
    width(row.querySelector('i'), w.done / most);
    width(row.querySelector('.held'), w.held / most);
    write(cells[3], grouped(w.done));
    write(cells[4], grouped(w.held));
    write(cells[5], unit(w.speed));
    write(cells[6], bytes(w.rss_bytes));
    write(cells[7], Math.round(w.heartbeat_s) + ' s ago');
  };
}

function show_run(s) {
  // Not full before all is done.
  const share = s.work.known ? s.work.done / s.work.known : 0;
  width(at('done'), share);
  const told = s.jobs.known > 0;  // what there is to do, and what of it was done
  write(at('percent'), told ? Math.floor(100 * share + 1e-9) + ' %' : '–');
  write(at('jobs'), told ? grouped(s.jobs.done) + ' of ' + grouped(s.jobs.known) + ' jobs' : 'of all jobs');
  write(at('rate'), s.triangles_per_s > 0 ? unit(s.triangles_per_s) : '–');
  write(at('left'), s.eta_s === null ? '–' : span(s.eta_s));
  write(at('room'), s.free_bytes === null ? '–' : bytes(s.free_bytes));
  write(at('more'), grouped(s.jobs.running) + ' running, ' + grouped(s.jobs.failed) + ' failed, ' +
    grouped(s.jobs.retried) + ' retried' + (s.bad_hosts.length ?
      '; no more jobs for ' + s.bad_hosts.join(', ') + ': too many failed there' : ''));
  fill(at('stages'), s.stages, make_stage, show_stage);
  write(at('crew'), grouped(s.workers.length) + ' at work or waiting, ' + grouped(s.workers_left) +
    ' left or were lost');
  const most = Math.max(1, ...s.workers.map((w) => w.done + w.held));
  fill(at('workers'), s.workers, make_worker, show_worker(most));
}

function warn(text) {
  write(at('problem'), text);
  at('problem').hidden = !text;
}

let seen = 0;  // when an answer came, in milliseconds

function show(s) {
  seen = performance.now();
  document.body.classList.remove('stale');
  const has_run = 'run' in s;
  const title = s.stage.replace(/\/+$/, '').split('/').pop();
  write(at('stage'), title);
  document.title = (has_run && !s.over && s.work.known ?
    Math.floor(100 * s.work.done / s.work.known) + ' % · ' : '') + title;
  write(at('about'), s.input + ', ' + grouped(s.triangles) + ' triangles in ' + grouped(s.parts) +
    ' parts' + (has_run ? '; epoch ' + s.epoch + ' on ' + s.host + ', for ' + span(s.elapsed_s) : ''));
  write(at('phase'), has_run ? s.phase : 'runs: ' + s.run_phase);
  at('phase').classList.toggle('warns', Boolean(s.warns));
  warn(s.problem);
  at('run').hidden = !has_run;
  if (has_run) show_run(s);
}

// What is shown is old then, and must not look as if it were not.
function fail() {
  document.body.classList.add('stale');
  warn('No answer from meshfarm status --serve' +
    (seen ? ' for ' + span((performance.now() - seen) / 1000) : '') +
    ': it was ended, or cannot be reached.');
}

async function turn() {
  if (!document.hidden) {
    try {
      const answer = await fetch('status.json', {cache: 'no-store', signal: AbortSignal.timeout(5000)});
      if (!answer.ok) throw new Error(answer.statusText);
      show(await answer.json());
    } catch (error) {
      fail();
    }
  }
  setTimeout(turn, 1000);
}

document.addEventListener('visibilitychange', () => {
  if (document.hidden) document.body.classList.add('stale');  // until the next answer
});
turn();
