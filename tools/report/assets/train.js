// The instant that the slider chooses: the train on the deflected bridge, and the chosen wheelset on its rails.
(function () {
  'use strict';
  const section = document.getElementById('theatre');
  if (!section) return;
  const stored = JSON.parse(document.getElementById('frames').textContent);
  const el = railtab.element, shown = railtab.shown;
  const time = railtab.floats(stored.time), position = railtab.floats(stored.position);
  const array = {};
  ['deck_z', 'body_z', 'body_pitch', 'Q', 'Y', 'patches', 'from_table', 'y_rail', 'y_wheel', 'angle', 'force',
    'second_y_rail', 'second_force'].forEach(function (name) { array[name] = railtab.numbers(stored[name]); });
  const wheels = stored.wheel_x.length, sets = wheels / 2, frames = stored.frames;
  const deck = stored.deck_x.length, bodies = stored.body_x.length, spans = stored.spans[0].length;
  const outlines = stored.wheel[0].length > 1 && stored.rail[0].length > 1;
  let frame = 0, wheelset = 0, playing = null;

  function largest(values) {
    let most = 0;
    for (let i = 0; i < values.length; ++i) if (Math.abs(values[i]) > most) most = Math.abs(values[i]);
    return most;
  }
  const most_deck = largest(array.deck_z), half_body = 12;
  const most_body = Math.max(largest(array.body_z), half_body * largest(array.body_pitch));  // at its ends
  function wheel(name, w) { return array[name][frame * wheels + w]; }
  function kN(v) { return shown(1e-3 * v) + '\u00a0kN'; }
  function signed(v) { return isFinite(v) ? v : 0; }
  // "table", "online search" or nothing where the results do not say.
  function source(w) {
    const s = wheel('from_table', w);
    return isNaN(s) || !outlines ? '' : s > 0.5 ? 'table' : 'online search';
  }

  // Controls
  const bar = el(section, 'div', 'bar');
  const play = el(bar, 'button', '', 'Play'); play.type = 'button'; play.id = 'play';
  const slider = el(bar, 'input'); slider.type = 'range'; slider.id = 'instant'; slider.min = 0; slider.max = frames - 1;
  slider.value = 0; slider.setAttribute('aria-label', 'instant of the run');
  const clock = el(bar, 'output'); clock.id = 'clock';
  const set_label = el(bar, 'label', '', 'Wheelset '), set_choice = el(set_label, 'select'); set_choice.id = 'wheelset';
  for (let w = 0; w < sets; ++w) { const o = el(set_choice, 'option', '', String(w + 1)); o.value = w; }
  const view_label = el(bar, 'label', '', 'View '), view = el(view_label, 'select'); view.id = 'view';
  [['line', 'whole line'], ['train', 'with the train'], ['wheelset', 'with the wheelset']].forEach(function (v) {
    el(view, 'option', '', v[1]).value = v[0];
  });
  const train_canvas = el(section, 'canvas'); train_canvas.id = 'train-canvas'; train_canvas.style.height = '270px';
  train_canvas.setAttribute('role', 'img');
  const wheel_canvas = el(section, 'canvas'); wheel_canvas.id = 'wheel-canvas'; wheel_canvas.setAttribute('role', 'img');
  wheel_canvas.hidden = !outlines;
  const reading = el(section, 'p', 'reading');

  const tail = Math.min.apply(null, stored.wheel_x);
  const line_from = Math.min.apply(null, [position[0] + tail].concat(stored.spans[0])) - 6;
  const line_to = Math.max.apply(null, [position[frames - 1]].concat(stored.spans[1])) + 6;
  view.value = line_to - line_from <= 300 ? 'line' : 'train';

  function range() {
    const x = position[frame];
    if (view.value === 'line') return [line_from, line_to];
    if (view.value === 'train') return [x + tail - 8, x + 8];
    const at = x + stored.wheel_x[2 * wheelset];
    return [at - 20, at + 20];
  }

  // Deflection of the deck [m]: a beam that is free to turn on its supports, through the recorded nodes.
  function span_line(s) {
    const from = stored.spans[0][s], to = stored.spans[1][s], sums = new Map();
    for (let i = 0; i < deck; ++i) {
      const x = stored.deck_x[i];
      if (x <= from + 1e-6 || x >= to - 1e-6) continue;
      const sum = sums.get(x) || [0, 0];
      sums.set(x, [sum[0] + signed(array.deck_z[frame * deck + i]), sum[1] + 1]);
    }
    const points = [[from, 0]];
    Array.from(sums.keys()).sort(function (a, b) { return a - b; }).forEach(function (x) {
      points.push([x, sums.get(x)[0] / sums.get(x)[1]]);
    });
    points.push([to, 0]);
    return points;
  }
  // Second derivatives of the natural cubic spline through points.
  function bending(p) {
    const n = p.length, m = new Array(n).fill(0), c = new Array(n).fill(0), d = new Array(n).fill(0);
    for (let i = 1; i < n - 1; ++i) {
      const h0 = p[i][0] - p[i - 1][0], h1 = p[i + 1][0] - p[i][0];
      const right = 6 * ((p[i + 1][1] - p[i][1]) / h1 - (p[i][1] - p[i - 1][1]) / h0), pivot = 2 * (h0 + h1) - h0 * c[i - 1];
      c[i] = h1 / pivot;
      d[i] = (right - h0 * d[i - 1]) / pivot;
    }
    for (let i = n - 2; i > 0; --i) m[i] = d[i] - c[i] * m[i + 1];
    return m;
  }
  function on_spline(p, m, x) {
    let i = 0;
    while (i < p.length - 2 && x > p[i + 1][0]) ++i;
    const h = p[i + 1][0] - p[i][0], a = (p[i + 1][0] - x) / h, b = (x - p[i][0]) / h;
    return a * p[i][1] + b * p[i + 1][1] + ((a * a * a - a) * m[i] + (b * b * b - b) * m[i + 1]) * h * h / 6;
  }

  function surface(canvas, height) {
    const ratio = window.devicePixelRatio || 1, width = canvas.clientWidth;
    canvas.style.height = height + 'px';
    canvas.width = Math.round(width * ratio); canvas.height = Math.round(height * ratio);
    const c = canvas.getContext('2d');
    c.setTransform(ratio, 0, 0, ratio, 0, 0);
    c.clearRect(0, 0, width, height);
    c.font = '12px system-ui, sans-serif';
    return {c: c, width: width, height: height};
  }
  function round_factor(f) {
    const power = Math.pow(10, Math.floor(Math.log10(f)));
    return (f / power >= 5 ? 5 : f / power >= 2 ? 2 : 1) * power;
  }
  function arrow(c, x, y, dx, dy, name) {
    const length = Math.hypot(dx, dy);
    if (length < 2) {
      if (name) c.fillText(name, x + 8, y - 6);
      return;
    }
    const ux = dx / length, uy = dy / length, head = Math.min(9, length);
    c.beginPath(); c.moveTo(x, y); c.lineTo(x + dx, y + dy); c.stroke();
    c.beginPath(); c.moveTo(x + dx, y + dy);
    c.lineTo(x + dx - head * ux + 0.4 * head * uy, y + dy - head * uy - 0.4 * head * ux);
    c.lineTo(x + dx - head * ux - 0.4 * head * uy, y + dy - head * uy + 0.4 * head * ux);
    c.fill();
    if (name) c.fillText(name, x + dx + (ux < -0.3 ? -6 - c.measureText(name).width : 6), y + dy + (uy > 0.3 ? 4 : -4));
  }
  // Solid: from the table; ring: from the online search.
  function dot(c, x, y, r, from) {
    const online = from === 'online search';
    c.beginPath(); c.arc(x, y, r, 0, 2 * Math.PI);
    c.lineWidth = online ? 2.5 : 1;
    c.strokeStyle = c.fillStyle = railtab.colour(online ? '--online' : from ? '--table' : '--ink');
    if (online) { c.save(); c.fillStyle = railtab.colour('--paper'); c.fill(); c.restore(); } else c.fill();
    c.stroke();
  }

  function draw_train() {
    const s = surface(train_canvas, 270), c = s.c, r = range(), scale = s.width / (r[1] - r[0]);
    const level = 150, X = function (x) { return (x - r[0]) * scale; };
    const rounding = 1e-9;  // m, which nothing shows
    const deck_factor = most_deck > rounding ? round_factor(34 / (most_deck * scale)) : 1;
    const body_factor = most_body > rounding ? round_factor(Math.min(24 / (most_body * scale), deck_factor)) : 1;
    const lines = [];
    for (let k = 0; k < spans; ++k) {
      if (stored.spans[1][k] < r[0] || stored.spans[0][k] > r[1]) continue;
      const p = span_line(k);
      lines.push({p: p, m: bending(p), from: p[0][0], to: p[p.length - 1][0]});
    }
    const depth = function (x) {
      for (const l of lines) if (x >= l.from && x <= l.to) return on_spline(l.p, l.m, x) * deck_factor * scale;
      return 0;
    };
    // ground and piers
    c.strokeStyle = railtab.colour('--axis'); c.lineWidth = 1;
    c.setLineDash([3, 4]); c.beginPath(); c.moveTo(0, level); c.lineTo(s.width, level); c.stroke(); c.setLineDash([]);
    c.strokeStyle = railtab.colour('--ink'); c.lineWidth = 2;
    const gaps = lines.map(function (l) { return [X(l.from), X(l.to)]; });
    let from = 0;
    gaps.concat([[s.width, s.width]]).forEach(function (g) {
      if (g[0] > from) { c.beginPath(); c.moveTo(from, level); c.lineTo(g[0], level); c.stroke(); }
      from = g[1];
    });
    c.fillStyle = railtab.colour('--steel');
    lines.forEach(function (l) {
      [l.from, l.to].forEach(function (x) {
        c.beginPath(); c.moveTo(X(x), level + 9); c.lineTo(X(x) - 5, level + 19); c.lineTo(X(x) + 5, level + 19); c.fill();
      });
      c.beginPath();
      const parts = Math.max(8, Math.min(60, Math.round((X(l.to) - X(l.from)) / 6)));
      for (let i = 0; i <= parts; ++i) {
        const x = l.from + (l.to - l.from) * i / parts;
        c.lineTo(X(x), level + on_spline(l.p, l.m, x) * deck_factor * scale);
      }
      for (let i = parts; i >= 0; --i) {
        const x = l.from + (l.to - l.from) * i / parts;
        c.lineTo(X(x), level + 8 + on_spline(l.p, l.m, x) * deck_factor * scale);
      }
      c.fillStyle = railtab.colour('--deck'); c.fill();
      c.strokeStyle = railtab.colour('--ink'); c.lineWidth = 1; c.stroke();
      c.fillStyle = railtab.colour('--steel');
    });
    for (let i = 0; i < deck; ++i) {
      const x = stored.deck_x[i];
      if (x < r[0] || x > r[1]) continue;
      c.beginPath(); c.arc(X(x), level + 4 + signed(array.deck_z[frame * deck + i]) * deck_factor * scale, 2.2, 0, 7);
      c.fillStyle = railtab.colour('--ink'); c.fill();
    }
    // car bodies
    for (let b = 0; b < bodies; ++b) {
      const x = position[frame] + stored.body_x[b], near = bodies > 1 ?
        Math.min.apply(null, stored.body_x.map(function (o, i) { return i === b ? Infinity : Math.abs(o - stored.body_x[b]); })) : 24;
      const half = 0.5 * (near - 0.8), height = Math.max(14, 2.7 * scale);
      if (x + half < r[0] || x - half > r[1]) continue;
      c.save();
      c.translate(X(x), level - Math.max(8, 1.1 * scale) + signed(array.body_z[frame * bodies + b]) * body_factor * scale);
      c.rotate(-signed(array.body_pitch[frame * bodies + b]) * body_factor);
      c.fillStyle = railtab.colour('--panel'); c.strokeStyle = railtab.colour('--ink'); c.lineWidth = 1.2;
      c.fillRect(-half * scale, -height, 2 * half * scale, height);
      c.strokeRect(-half * scale, -height, 2 * half * scale, height);
      const name = stored.body_names[b].replace('/car-body', '').replace('coach-', 'coach ');
      if (c.measureText(name).width < 2 * half * scale) {
        c.fillStyle = railtab.colour('--soft'); c.textAlign = 'center'; c.fillText(name, 0, -0.5 * height + 4);
      }
      c.restore();
    }
    // wheelsets and their forces
    const base = level + 44, unit = 30, radius = Math.max(3.5, Math.min(12, 0.46 * scale));
    let any = false;
    for (let w = 0; w < sets; ++w) {
      const x = position[frame] + stored.wheel_x[2 * w];
      if (x < r[0] || x > r[1]) continue;
      any = true;
      const down = depth(x), sum = wheel('Q', 2 * w) + wheel('Q', 2 * w + 1), load = stored.load[2 * w] + stored.load[2 * w + 1];
      const online = [2 * w, 2 * w + 1].some(function (i) { return source(i) === 'online search'; });
      dot(c, X(x), level + down - radius, radius, online ? 'online search' : source(2 * w));
      const long = load > 0 ? unit * sum / load : 0, wide = Math.max(3, Math.min(10, 0.5 * scale));
      c.fillStyle = railtab.colour(w === wheelset ? '--c3' : '--c0');
      c.fillRect(X(x) - 0.5 * wide, base, wide, Math.max(0, Math.min(64, long)));
      if (w === wheelset) {
        c.beginPath(); c.moveTo(X(x), base - 3); c.lineTo(X(x) - 5, base - 11); c.lineTo(X(x) + 5, base - 11); c.fill();
      }
    }
    c.fillStyle = railtab.colour('--soft'); c.strokeStyle = railtab.colour('--axis'); c.lineWidth = 1;
    if (any) {
      c.setLineDash([3, 3]);
      c.beginPath(); c.moveTo(0, base + unit); c.lineTo(s.width, base + unit); c.stroke(); c.setLineDash([]);
      c.fillText(s.width > 500 ? 'static load of a wheelset' : 'static load', 4, base + unit + 14);
    }
    const notes = [];
    if (deck && spans) notes.push('deck \u00d7' + shown(deck_factor));
    if (bodies) notes.push('car bodies \u00d7' + shown(body_factor));
    c.fillText(notes.join(', '), 4, 14);
    // scale of x
    const step = 1 / round_factor(s.width / (70 * (r[1] - r[0])));  // labels have 70 px at least
    c.textAlign = 'center';
    for (let x = Math.ceil(r[0] / step) * step; x <= r[1]; x += step) {
      c.beginPath(); c.moveTo(X(x), 246); c.lineTo(X(x), 251); c.stroke();
      if (X(x) < 18 || X(x) > s.width - 22) continue;  // no room for its label
      c.fillText(shown(Math.abs(x) < 1e-9 ? 0 : x) + ' m', X(x), 264);
    }
    train_canvas.setAttribute('aria-label', 'Train at x = ' + shown(position[frame]) + ' m, t = ' + shown(time[frame]) +
      ' s' + (deck ? '; largest displacement of the recorded deck nodes ' + shown(1e3 * deck_now()) + ' mm' : ''));
  }
  function deck_now() { return largest(array.deck_z.subarray(frame * deck, (frame + 1) * deck)); }

  // z [m] of an outline at y; of several, the highest (rail) or the lowest (wheel).
  function outline_z(outline, y, lowest) {
    let found = NaN;
    for (let i = 0; i + 1 < outline[0].length; ++i) {
      const a = outline[0][i], b = outline[0][i + 1];
      if (a === b || (y - a) * (y - b) > 0) continue;
      const z = outline[1][i] + (outline[1][i + 1] - outline[1][i]) * (y - a) / (b - a);
      if (isNaN(found) || (lowest ? z > found : z < found)) found = z;
    }
    return found;
  }
  const last_shift = new Float64Array(wheels);

  function draw_side(c, w, x0, width, height) {
    const left = w % 2 === 0, scale = width / 0.156, mirror = left ? -1 : 1;
    const middle = x0 + width * (left ? 0.46 : 0.54), top = 0.6 * height;
    const X = function (y) { return middle + mirror * y * scale; }, Z = function (z) { return top + z * scale; };
    const contact = wheel('patches', w) > 0.5, y_rail = wheel('y_rail', w), y_wheel = wheel('y_wheel', w);
    if (contact) last_shift[w] = y_rail - y_wheel;
    const z_contact = outline_z(stored.rail, y_rail, false);
    const lift = contact ? z_contact - outline_z(stored.wheel, y_wheel, true) : -0.008;
    c.save();
    c.beginPath(); c.rect(x0, 0, width, height); c.clip();
    function shape(outline, dy, dz, fill, far) {
      c.beginPath();
      for (let i = 0; i < outline[0].length; ++i) c.lineTo(X(outline[0][i] + dy), Z(outline[1][i] + dz));
      const ends = [outline[0][outline[0].length - 1] + dy, outline[0][0] + dy];
      c.lineTo(X(ends[0]), far); c.lineTo(X(ends[1]), far); c.closePath();
      c.fillStyle = railtab.colour(fill); c.globalAlpha = 0.45; c.fill(); c.globalAlpha = 1;
      c.strokeStyle = railtab.colour('--ink'); c.lineWidth = 1.3; c.lineJoin = 'round'; c.stroke();
    }
    shape(stored.rail, 0, 0, '--steel', height + 20);
    // the outline of other wheels' profile is not stored
    const own = stored.outline.length === 0 || stored.outline[w] === 1;
    if (own) shape(stored.wheel, last_shift[w], isNaN(lift) ? 0 : lift, '--deck', -20);
    const from = source(w), load = stored.load[w] || 1, per = 0.22 * height / load;
    const total = signed(wheel('force', w)) + signed(wheel('second_force', w));
    function patch(y, force) {
      const z = outline_z(stored.rail, y, false);
      if (isNaN(y) || isNaN(z) || !(total > 0)) return;
      const half = 0.006 * force / total, d = 5e-4;
      const a = outline_z(stored.rail, y - d, false), b = outline_z(stored.rail, y + d, false);
      const slope = isNaN(a) || isNaN(b) ? 0 : (b - a) / (2 * d), n = Math.hypot(1, slope);
      c.strokeStyle = c.fillStyle = railtab.colour(from === 'online search' ? '--online' : '--table');
      c.lineWidth = 5; c.setLineDash(from === 'online search' ? [4, 2] : []);
      c.beginPath(); c.moveTo(X(y - half / n), Z(z - slope * half / n)); c.lineTo(X(y + half / n), Z(z + slope * half / n)); c.stroke();
      c.setLineDash([]); c.lineWidth = 1.6;
      arrow(c, X(y), Z(z), mirror * -slope / n * force * per, force * per / n, '');
    }
    if (contact) {
      patch(y_rail, signed(wheel('force', w)));
      patch(wheel('second_y_rail', w), signed(wheel('second_force', w)));
    }
    c.fillStyle = c.strokeStyle = railtab.colour('--c3'); c.lineWidth = 2;
    const at = contact ? y_rail : 0, z0 = contact && !isNaN(z_contact) ? z_contact : 0;
    arrow(c, X(at), Z(z0), 0, signed(wheel('Q', w)) * per, 'Q ' + kN(wheel('Q', w)));
    c.fillStyle = c.strokeStyle = railtab.colour('--c2');
    arrow(c, X(at), Z(z0) + 2, signed(wheel('Y', w)) * per, 0, 'Y ' + kN(wheel('Y', w)));
    c.fillStyle = railtab.colour('--soft'); c.textAlign = left ? 'left' : 'right';
    c.fillText((left ? 'left' : 'right') + (contact ? '' : ': no contact') + (from && contact ? ': ' + from : ''),
      left ? x0 + 4 : x0 + width - 4, height - 8);
    c.restore();
  }
  function places_text(first, second) {
    if (!isFinite(first)) return '';
    return ' at y = ' + shown(1e3 * first) + (isFinite(second) ? ' and ' + shown(1e3 * second) : '') + ' mm on the rail';
  }
  function side_text(w) {
    const from = source(w), q = wheel('Q', w), patches = Math.round(wheel('patches', w));
    return (w % 2 ? 'right' : 'left') + ' Q ' + kN(q) + ', Y ' + kN(wheel('Y', w)) +
      (q > 0 ? ', Y/Q ' + shown(wheel('Y', w) / q) : '') + (outlines ? ', ' + patches + (patches === 1 ? ' patch' : ' patches') : '') +
      places_text(wheel('y_rail', w), wheel('second_y_rail', w)) +
      (from ? ', by the ' + from : '');
  }
  function draw_wheelset() {
    if (outlines) {
      const narrow = wheel_canvas.clientWidth < 560, s = surface(wheel_canvas, narrow ? 520 : Math.min(420, 0.34 * wheel_canvas.clientWidth + 60));
      if (narrow) {
        draw_side(s.c, 2 * wheelset, 0, s.width, 255);
        s.c.save(); s.c.translate(0, 265); draw_side(s.c, 2 * wheelset + 1, 0, s.width, 255); s.c.restore();
      } else {
        const width = Math.min(0.48 * s.width, 660);
        draw_side(s.c, 2 * wheelset, 0.5 * s.width - width - 12, width, s.height);
        draw_side(s.c, 2 * wheelset + 1, 0.5 * s.width + 12, width, s.height);
      }
    }
    reading.textContent = 'Wheelset ' + (wheelset + 1) + ': ' + side_text(2 * wheelset) + '; ' + side_text(2 * wheelset + 1) + '.';
    wheel_canvas.setAttribute('aria-label', 'Wheel profiles on their rails. ' + reading.textContent);
  }
  function draw() {
    clock.textContent = 't = ' + time[frame].toFixed(3) + ' s, x = ' + position[frame].toFixed(1) + ' m';
    slider.setAttribute('aria-valuetext', clock.textContent);
    draw_train();
    draw_wheelset();
    railtab.set_now(time[frame], position[frame] + stored.wheel_x[2 * wheelset]);
  }
  function show(k) {
    frame = Math.max(0, Math.min(frames - 1, Math.round(k)));
    slider.value = frame;
    draw();
  }
  function stop() {
    cancelAnimationFrame(playing); playing = null; play.textContent = 'Play';
  }
  play.addEventListener('click', function () {
    if (playing !== null) { stop(); return; }
    play.textContent = 'Pause';
    if (frame === frames - 1) frame = 0;
    const per_second = Math.max(frames / 20, Math.min(30, frames / 5)), begin = performance.now(), first = frame;
    (function step(now) {
      show(first + per_second * Math.max(0, (now || begin) - begin) / 1000);
      if (frame === frames - 1) stop(); else playing = requestAnimationFrame(step);
    })();
  });
  slider.addEventListener('input', function () { if (playing !== null) stop(); show(Number(slider.value)); });
  set_choice.addEventListener('change', function () { wheelset = Number(set_choice.value); draw(); });
  view.addEventListener('change', draw);
  railtab.on_time = function (t) {
    let low = 0, high = frames - 1;
    while (high - low > 1) { const m = (low + high) >> 1; if (time[m] <= t) low = m; else high = m; }
    show(t - time[low] < time[high] - t ? low : high);
  };
  railtab.on_theme = draw;
  section.classList.add('ready');
  if ('ResizeObserver' in window) new ResizeObserver(draw).observe(section);
  draw();
})();
