// Charts drawn from stored histories: zoom, cursors that move together, choice of channels. The static figures stay for
// paper. A history holds 16-bit numbers, every record or the smallest and largest of every so many (history_store.hpp).
const railtab = (function () {
  'use strict';
  const GAP = 65535, MOST_ROWS = 2500;
  const DASHES = [null, null, null, null, [7, 3], [2, 2], [9, 3, 2, 3], [4, 4]];
  const store = JSON.parse(document.getElementById('histories').textContent);

  function bytes(text) {
    const raw = atob(text), result = new Uint8Array(raw.length);
    for (let i = 0; i < raw.length; ++i) result[i] = raw.charCodeAt(i);
    return result;
  }
  function floats(text) { return new Float32Array(bytes(text).buffer); }
  function numbers(of) {
    const stored = new Uint16Array(bytes(of.data).buffer), values = new Float64Array(stored.length);
    for (let i = 0; i < stored.length; ++i) values[i] = stored[i] === GAP ? NaN : of.low + of.step * stored[i];
    return values;
  }
  const runs = store.runs.map(function (run) {
    return {name: run.name, time: floats(run.time), position: floats(run.position)};
  });
  function history(k) {
    const entry = store.histories[k];
    if (!entry.values) entry.values = numbers(entry.of);
    return entry;
  }
  function colour(name) { return getComputedStyle(document.documentElement).getPropertyValue(name).trim(); }
  function shown(v) {
    if (!isFinite(v)) return '\u2013';
    return (v === 0 ? '0' : Number(v.toPrecision(4)).toString()).replace(/-/g, '\u2212');
  }
  function element(parent, tag, name, text) {
    const made = parent.appendChild(document.createElement(tag));
    if (name) made.className = name;
    if (text !== undefined) made.textContent = text;
    return made;
  }

  // One line: its values and, over a kind of axis, its x.
  function Line(data, style) {
    Object.assign(this, data);
    this.style = style;
  }
  Line.prototype.load = function () {
    if (this.values) return;
    const stored = history(this.history);
    this.every = stored.every;
    this.values = stored.values;
    this.records = runs[this.run].time.length;
  };
  Line.prototype.record = function (j) {
    if (this.every === 1) return j;
    return Math.min(this.records - 1, (j >> 1) * this.every + Math.floor((j & 1 ? 3 : 1) * this.every / 4));
  };
  Line.prototype.x = function (j, kind) {
    const k = this.record(j);
    return kind === 'time' ? runs[this.run].time[k] : runs[this.run].position[k] + this.offset;
  };
  Line.prototype.y = function (j) { return this.values[j] * this.factor + this.shift; };
  // The first point at or after x.
  Line.prototype.from = function (x, kind) {
    let low = 0, high = this.values.length;
    while (low < high) {
      const middle = (low + high) >> 1;
      if (this.x(middle, kind) < x) low = middle + 1; else high = middle;
    }
    return low;
  };
  // What a reader sees at x: the nearest record, or the range that is stored around it.
  Line.prototype.at = function (x, kind) {
    this.load();
    let j = this.from(x, kind);
    if (j === this.values.length || (j > 0 && x - this.x(j - 1, kind) < this.x(j, kind) - x)) --j;
    if (j < 0) return '\u2013';
    const last = this.values.length - 1, reach = 3 * Math.abs(this.x(last, kind) - this.x(0, kind)) / Math.max(1, last);
    if (Math.abs(this.x(j, kind) - x) > reach + 1e-9) return '\u2013';
    if (this.every === 1) return shown(this.y(j));
    const a = this.y(j & ~1), b = this.y(j | 1);
    return shown(Math.min(a, b)) + ' \u2026 ' + shown(Math.max(a, b));
  };

  const charts = [], windows = {}, cursors = {}, places = {};
  let wheels_over = 'position', visible = null;

  function Chart(figure) {
    const data = JSON.parse(figure.querySelector('.chart-data').textContent);
    this.figure = figure;
    this.over = data.over;
    this.data = data;
    let next = 0;
    this.lines = data.series.map(function (s) { return new Line(s, s.shown ? next++ : -1); });
    this.bands = data.bands.map(function (b) {
      return {label: b.label, x: floats(b.x), low: floats(b.low), high: floats(b.high)};
    });
    this.graph = null;
    this.stale = true;
  }
  Chart.prototype.kind = function () { return this.over === 'position' ? wheels_over : this.over; };
  Chart.prototype.chosen = function () { return this.lines.filter(function (l) { return l.shown; }); };

  // Rows for dygraphs in a window: the points themselves where they are few, else smallest and largest per column.
  Chart.prototype.rows = function (from, to, columns) {
    const kind = this.kind(), lines = this.chosen(), ends = [];
    let points = 0;
    lines.forEach(function (line) {
      line.load();
      const first = Math.max(0, line.from(from, kind) - 1), end = Math.min(line.values.length, line.from(to, kind) + 1);
      ends.push([first, end]);
      points += end - first;
    });
    return points <= MOST_ROWS ? merged(lines, ends, kind) : gathered(lines, ends, kind, from, to, columns);
  };
  function merged(lines, ends, kind) {
    const points = [];
    lines.forEach(function (line, s) {
      for (let j = ends[s][0]; j < ends[s][1]; ++j) points.push([line.x(j, kind), s, line.y(j)]);
    });
    points.sort(function (a, b) { return a[0] - b[0]; });
    const rows = [];
    points.forEach(function (p) {
      let row = rows[rows.length - 1];
      if (!row || row[0] !== p[0]) {
        row = new Array(lines.length + 1).fill(null);
        row[0] = p[0];
        rows.push(row);
      }
      row[p[1] + 1] = p[2];
    });
    return rows;
  }
  function gathered(lines, ends, kind, from, to, columns) {
    const width = (to - from) / columns, rows = [];
    for (let k = -1; k <= columns; ++k) {
      for (let half = 0.25; half < 1; half += 0.5) {
        const row = new Array(lines.length + 1).fill(null);
        row[0] = from + (k + half) * width;
        rows.push(row);
      }
    }
    lines.forEach(function (line, s) {
      let column = -2, least = NaN, most = NaN, least_at = 0, most_at = 0, any = false;
      function close() {
        if (column < -1 || !any) return;
        const r = 2 * (column + 1), first = least_at < most_at ? least : most, second = least_at < most_at ? most : least;
        rows[r][s + 1] = first;
        rows[r + 1][s + 1] = second;
      }
      for (let j = ends[s][0]; j < ends[s][1]; ++j) {
        const at = Math.max(-1, Math.min(columns, Math.floor((line.x(j, kind) - from) / width)));
        if (at !== column) {
          close();
          column = at; least = most = NaN; any = true;
        }
        const y = line.y(j);
        if (!(y >= least)) { if (!isNaN(y)) { least = y; least_at = j; } }
        if (!(y <= most)) { if (!isNaN(y)) { most = y; most_at = j; } }
      }
      close();
    });
    return rows;
  }

  function extent(kind) {
    let low = Infinity, high = -Infinity;
    charts.forEach(function (chart) {
      if (chart.kind() !== kind) return;
      chart.lines.forEach(function (line) {
        const run = runs[line.run], x = kind === 'time' ? run.time : run.position;
        const offset = kind === 'time' ? 0 : line.offset;
        low = Math.min(low, x[0] + offset);
        high = Math.max(high, x[x.length - 1] + offset);
      });
    });
    return high > low ? [low, high] : [low, low + 1];
  }
  function window_of(kind) {
    if (!windows[kind]) windows[kind] = extent(kind);
    return windows[kind];
  }

  // Axis of y: everything drawn and the limits.
  Chart.prototype.range = function (rows) {
    let low = Infinity, high = -Infinity;
    function take(v) { if (v !== null && isFinite(v)) { low = Math.min(low, v); high = Math.max(high, v); } }
    rows.forEach(function (row) { for (let i = 1; i < row.length; ++i) take(row[i]); });
    this.data.limits.forEach(function (limit) { take(limit.value); });
    if (this.kind() === this.over) {
      const range = window_of(this.over);
      this.bands.forEach(function (band) {
        for (let i = 0; i < band.x.length; ++i) {
          if (band.x[i] >= range[0] && band.x[i] <= range[1]) { take(band.low[i]); take(band.high[i]); }
        }
      });
    }
    if (!(high >= low)) return [0, 1];
    const pad = high > low ? 0.05 * (high - low) : Math.max(1e-9, 0.05 * Math.abs(high));
    return [low - pad, high + pad];
  };
  Chart.prototype.options = function () {
    const chart = this, lines = this.chosen(), range = window_of(this.kind());
    const columns = Math.max(200, Math.min(900, Math.floor(this.place.clientWidth || 800)));
    let rows = this.rows(range[0], range[1], columns);
    if (rows.length === 0) {
      const nothing = new Array(Math.max(1, lines.length)).fill(null);
      rows = range.map(function (x) { return [x].concat(nothing); });
    }
    const series = {};
    lines.forEach(function (line, i) {
      if (DASHES[line.style % 8]) series['s' + i] = {strokePattern: DASHES[line.style % 8]};
    });
    return {
      file: rows, labels: ['x'].concat(lines.length ? lines.map(function (l, i) { return 's' + i; }) : ['none']),
      colors: lines.length ? lines.map(function (l) { return colour('--c' + l.style % 8); }) : ['transparent'],
      series: series, dateWindow: range.slice(), valueRange: this.range(rows),
      gridLineColor: colour('--grid'), axisLineColor: colour('--axis'),
      underlayCallback: function (context, area, graph) { chart.underlay(context, area, graph); }
    };
  };
  Chart.prototype.underlay = function (context, area, graph) {
    const kind = this.kind(), own = kind === this.over, limits = this.data.limits.length;
    context.save();
    context.beginPath(); context.rect(area.x, area.y, area.w, area.h); context.clip();
    context.font = '12px system-ui, sans-serif';
    if (own) {
      let before = '';
      this.data.marks.forEach(function (mark) {
        const a = graph.toDomXCoord(mark.from), b = graph.toDomXCoord(mark.to);
        context.fillStyle = colour('--mark');
        context.fillRect(a, area.y, b - a, area.h);
        context.fillStyle = colour('--mark-edge');
        context.fillRect(a, area.y, 1, area.h); context.fillRect(b - 1, area.y, 1, area.h);
        context.fillStyle = colour('--soft');
        if (mark.label !== before && b > area.x && a < area.x + area.w) {
          context.fillText(mark.label, Math.max(a, area.x) + 4, area.y + (limits ? 36 : 12));
        }
        before = mark.label;
      });
      context.fillStyle = colour('--band');
      this.bands.forEach(function (band) {
        context.beginPath();
        for (let i = 0; i < band.x.length; ++i) context.lineTo(graph.toDomXCoord(band.x[i]), graph.toDomYCoord(band.high[i]));
        for (let i = band.x.length; i-- > 0;) context.lineTo(graph.toDomXCoord(band.x[i]), graph.toDomYCoord(band.low[i]));
        context.fill();
      });
    }
    this.data.limits.forEach(function (limit) {
      const y = graph.toDomYCoord(limit.value);
      context.strokeStyle = context.fillStyle = colour('--limit');
      context.setLineDash([6, 4]); context.lineWidth = 1.4;
      context.beginPath(); context.moveTo(area.x, y); context.lineTo(area.x + area.w, y); context.stroke();
      context.setLineDash([]);
      context.textAlign = 'right';
      context.fillText(limit.label, area.x + area.w - 4, y < area.y + 18 ? y + 13 : y - 5);
      context.textAlign = 'left';
    });
    context.restore();
  };

  Chart.prototype.open = function () {
    if (this.graph) { if (this.stale) this.redraw(); return; }
    const chart = this, figure = this.figure, live = element(figure, 'div', 'live');
    figure.classList.add('has-live');
    this.legend = element(live, 'ul', 'legend');
    this.head = element(live, 'div', 'chart-bar');
    element(this.head, 'span', 'y-label', this.data.y);
    const tools = element(this.head, 'span', 'tools');
    [['\u2212', 'zoom out', 2], ['+', 'zoom in', 0.5], ['all', 'show all', 0]].forEach(function (t) {
      const button = element(tools, 'button', '', t[0]);
      button.type = 'button'; button.title = t[1]; button.setAttribute('aria-label', t[1] + ': ' + chart.data.title);
      button.addEventListener('click', function () { chart.zoom(t[2]); });
    });
    this.frame = element(live, 'div', 'frame');
    this.frame.tabIndex = 0;
    this.frame.setAttribute('role', 'application');
    this.frame.setAttribute('aria-label', this.data.title + '. Arrow keys move the cursor, with shift the window; plus and ' +
                                          'minus zoom; 0 shows all.');
    this.place = element(this.frame, 'div', 'graph');
    this.line = element(this.frame, 'div', 'cursor'); this.now = element(this.frame, 'div', 'now');
    this.x_label = element(live, 'div', 'x-label');
    this.chooser(live);
    this.create();
    this.frame.addEventListener('pointermove', function (e) {
      const x = e.clientX - chart.place.getBoundingClientRect().left;
      point(chart.kind(), chart.graph.toDataXCoord(x));
    });
    this.frame.addEventListener('pointerleave', function () { point(chart.kind(), null); });
    this.frame.addEventListener('keydown', function (e) { chart.key(e); });
  };
  Chart.prototype.create = function () {
    const chart = this, options = this.options(), rows = options.file;
    delete options.file;
    const model = Object.assign({}, Dygraph.defaultInteractionModel);
    ['touchstart', 'touchmove', 'touchend'].forEach(function (name) { delete model[name]; });  // the page scrolls
    model.dblclick = function () { chart.zoom(0); };
    this.graph = new Dygraph(this.place, rows, Object.assign(options, {
      interactionModel: model, legend: 'never', showLabelsOnHighlight: false, highlightCircleSize: 0,
      connectSeparatedPoints: true, strokeWidth: 1.4, axisLabelFontSize: 12, rightGap: 14, xRangePad: 0,
      axes: {y: {axisLabelWidth: 50, pixelsPerLabel: 34, axisLabelFormatter: label},
             x: {pixelsPerLabel: 70, axisLabelFormatter: label}},
      drawCallback: function (graph) { chart.drawn(graph); },
      clickCallback: function (e, x) {
        const at = chart.graph.toDataXCoord(e.offsetX);
        if (chart.kind() === 'time' && api.on_time) api.on_time(isFinite(at) ? at : x);
      }
    }));
    this.stale = false;
    this.write_legend();
    this.write_x();
    this.show_now();
  };
  function label(v) {
    const digits = Math.abs(v) >= 1e4 ? 7 : 5;
    return (Math.abs(v) < 1e-12 ? '0' : Number(v.toPrecision(digits)).toString()).replace(/-/g, '\u2212');
  }
  Chart.prototype.write_x = function () {
    this.x_label.textContent = this.kind() === 'time' ? 'time [s]' : 'position of the wheel along the track [m]';
  };
  Chart.prototype.redraw = function () {
    if (!this.graph) return;
    this.drawing = true;
    this.graph.updateOptions(this.options());
    this.drawing = false;
    this.stale = false;
    this.write_x();
    this.show_cursor();
    this.show_now();
  };
  // A drag has zoomed or moved one chart: the others of its kind follow.
  Chart.prototype.drawn = function (graph) {
    if (this.drawing || !this.graph) return;
    const range = graph.xAxisRange(), kind = this.kind(), now = window_of(kind), small = 1e-9 * (now[1] - now[0]);
    if (Math.abs(range[0] - now[0]) <= small && Math.abs(range[1] - now[1]) <= small) return;
    requestAnimationFrame(function () { set_window(kind, range[0], range[1]); });
  };
  function set_window(kind, from, to) {
    const all = extent(kind), least = 1e-5 * (all[1] - all[0]);
    from = Math.max(all[0], from); to = Math.min(all[1], to);
    if (!(to - from > least)) return;
    windows[kind] = [from, to];
    charts.forEach(function (chart) {
      if (chart.kind() !== kind) return;
      chart.stale = true;
      if (!visible || visible.has(chart)) chart.redraw();
    });
  }
  Chart.prototype.zoom = function (factor) {
    const kind = this.kind(), all = extent(kind);
    if (factor === 0) { set_window(kind, all[0], all[1]); return; }
    const now = window_of(kind), at = cursors[kind];
    const centre = at !== undefined && at !== null && at > now[0] && at < now[1] ? at : 0.5 * (now[0] + now[1]);
    const from = centre - factor * (centre - now[0]), to = centre + factor * (now[1] - centre);
    set_window(kind, from, to);
  };
  Chart.prototype.key = function (e) {
    const kind = this.kind(), now = window_of(kind), width = now[1] - now[0];
    const step = e.key === 'ArrowLeft' ? -1 : e.key === 'ArrowRight' ? 1 : 0;
    if (step && e.shiftKey) {
      const all = extent(kind), by = Math.max(all[0] - now[0], Math.min(all[1] - now[1], 0.1 * step * width));
      set_window(kind, now[0] + by, now[1] + by);
    } else if (step) {
      const at = cursors[kind] === undefined || cursors[kind] === null ? 0.5 * (now[0] + now[1]) : cursors[kind];
      point(kind, Math.max(now[0], Math.min(now[1], at + 0.005 * step * width)));
    } else if (e.key === '+' || e.key === '=') this.zoom(0.5);
    else if (e.key === '-') this.zoom(2);
    else if (e.key === '0' || e.key === 'Home') this.zoom(0);
    else return;
    e.preventDefault();
  };

  // Cursors of all charts of a kind stand at one x.
  let pending = null;
  function point(kind, x) {
    cursors[kind] = x;
    if (pending) return;
    pending = requestAnimationFrame(function () {
      pending = null;
      charts.forEach(function (chart) { if (chart.graph && (!visible || visible.has(chart))) chart.show_cursor(); });
    });
  }
  Chart.prototype.put = function (line, x) {
    const range = this.graph.xAxisRange(), inside = x !== undefined && x !== null && x >= range[0] && x <= range[1];
    line.style.display = inside ? 'block' : 'none';
    if (inside) line.style.left = this.graph.toDomXCoord(x) + 'px';
  };
  Chart.prototype.show_cursor = function () {
    const kind = this.kind(), x = cursors[kind];
    this.put(this.line, x);
    const none = x === undefined || x === null;
    this.outputs.forEach(function (o) { o.output.textContent = none ? '' : o.line.at(x, kind); });
    this.at.textContent = none ? '' : (kind === 'time' ? 't = ' + shown(x) + ' s' : 'x = ' + shown(x) + ' m');
  };
  Chart.prototype.show_now = function () { this.put(this.now, places[this.kind()]); };

  Chart.prototype.write_legend = function () {
    const legend = this.legend;
    legend.textContent = '';
    this.outputs = this.chosen().map(function (line) {
      const item = element(legend, 'li');
      element(item, 'i', 'c' + line.style % 8);
      element(item, 'span', '', line.label);
      return {line: line, output: element(item, 'output')};
    });
    this.bands.forEach(function (band) {
      const item = element(legend, 'li');
      element(item, 'i', 'band'); element(item, 'span', '', band.label);
    });
    this.at = element(legend, 'li', 'at');
  };
  Chart.prototype.chooser = function (live) {
    const chart = this;
    if (this.lines.length < 2) return;
    const details = element(live, 'details', 'channels'), summary = element(details, 'summary');
    function count() { summary.textContent = 'Channels: ' + chart.chosen().length + ' of ' + chart.lines.length; }
    count();
    details.addEventListener('toggle', function () {
      if (details.querySelector('.choice')) return;
      const choice = element(details, 'div', 'choice');
      chart.lines.forEach(function (line) {
        const entry = element(choice, 'label'), box = element(entry, 'input');
        box.type = 'checkbox'; box.checked = line.shown;
        entry.append(' ' + line.label);
        box.addEventListener('change', function () {
          line.shown = box.checked;
          if (line.shown) line.style = chart.free_style();
          count();
          chart.rebuild();
        });
      });
    });
  };
  Chart.prototype.free_style = function () {
    const used = this.chosen().map(function (l) { return l.style; });
    let style = 0;
    while (used.indexOf(style) >= 0) ++style;
    return style;
  };
  Chart.prototype.rebuild = function () {
    if (!this.graph) return;
    this.graph.destroy(); this.graph = null;
    this.create();
    this.show_cursor();
  };

  function controls() {
    if (!charts.some(function (c) { return c.over === 'position'; })) return;
    const first = document.querySelector('figure .chart-data').closest('section');
    const bar = document.createElement('div');
    bar.className = 'controls';
    const entry = element(bar, 'label', '', 'Wheel charts over '), select = element(entry, 'select');
    select.id = 'wheels-over';
    [['position', 'position of the wheel'], ['time', 'time']].forEach(function (o) {
      const option = element(select, 'option', '', o[1]); option.value = o[0];
    });
    element(bar, 'span', 'hint', 'Drag to zoom, shift and drag to move, double-click for all; cursors move together.');
    select.addEventListener('change', function () {
      wheels_over = select.value;
      delete windows.position; delete windows.time;
      charts.forEach(function (chart) { if (chart.graph) chart.rebuild(); });
    });
    first.parentNode.insertBefore(bar, first);
  }

  document.querySelectorAll('figure').forEach(function (figure) {
    if (figure.querySelector('.chart-data')) charts.push(new Chart(figure));
  });
  charts.forEach(function (chart) { chart.figure.railtab = chart; });
  controls();
  if ('IntersectionObserver' in window) {
    visible = new Set();
    const observer = new IntersectionObserver(function (entries) {
      entries.forEach(function (entry) {
        const chart = entry.target.railtab;
        if (entry.isIntersecting) { visible.add(chart); chart.open(); } else visible.delete(chart);
      });
    }, {rootMargin: '300px'});
    charts.forEach(function (chart) {
      observer.observe(chart.figure);
      if (chart.figure.getBoundingClientRect().top < window.innerHeight + 300) { visible.add(chart); chart.open(); }
    });
  } else {
    charts.forEach(function (chart) { chart.open(); });
  }
  window.matchMedia('(prefers-color-scheme: dark)').addEventListener('change', function () {
    charts.forEach(function (chart) { chart.rebuild(); });
    if (api.on_theme) api.on_theme();
  });

  const api = {
    bytes: bytes, floats: floats, numbers: numbers, runs: runs, colour: colour, shown: shown, element: element,
    charts: charts, set_window: set_window, window_of: window_of,
    // The instant that is looked at: a line in charts over time, and over position where the chosen wheel is.
    set_now: function (time, position) {
      places.time = time; places.position = position;
      charts.forEach(function (chart) { if (chart.graph) chart.show_now(); });
    },
    on_time: null, on_theme: null
  };
  return api;
})();
