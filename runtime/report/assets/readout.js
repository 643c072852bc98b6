// Values under the pointer of a static chart, read back from the drawn lines.
document.querySelectorAll('.area').forEach(function (area) {
  const x = area.dataset.x.split(',').map(Number), y = area.dataset.y.split(',').map(Number);
  let lines = null, cursor, box;
  function load() {
    lines = [].map.call(area.querySelectorAll('path.line'), function (path) {
      const n = path.getAttribute('d').match(/[-.0-9]+/g).map(Number), a = [], b = [];
      for (let i = 0; i < n.length; i += 2) { a.push(n[i]); b.push(n[i + 1]); }
      return {label: path.dataset.label, a: a, b: b};
    });
    cursor = area.appendChild(document.createElement('div')); cursor.className = 'cursor';
    box = area.appendChild(document.createElement('div')); box.className = 'readout';
  }
  function shown(v) { return Number(v.toPrecision(4)).toString().replace('-', '\u2212'); }
  area.addEventListener('pointermove', function (e) {
    if (!lines) load();
    const r = area.getBoundingClientRect(), at = Math.min(1000, Math.max(0, 1000 * (e.clientX - r.left) / r.width));
    cursor.style.display = box.style.display = 'block'; cursor.style.left = at / 10 + '%';
    box.textContent = '';
    [area.dataset.xlabel + ': ' + shown(x[0] + at / 1000 * (x[1] - x[0]))].concat(lines.map(function (l) {
      let lo = 0, hi = l.a.length - 1;
      while (hi - lo > 1) { const m = (lo + hi) >> 1; if (l.a[m] <= at) lo = m; else hi = m; }
      const k = Math.abs(l.a[lo] - at) < Math.abs(l.a[hi] - at) ? lo : hi;
      if (Math.abs(l.a[k] - at) > 8) return l.label + ': \u2013';
      return l.label + ': ' + shown(y[0] + (1 - l.b[k] / 1000) * (y[1] - y[0]));
    })).forEach(function (t) { box.appendChild(document.createElement('div')).textContent = t; });
    box.style.left = at < 500 ? 'calc(' + at / 10 + '% + 10px)' : 'auto';
    box.style.right = at < 500 ? 'auto' : 'calc(' + (100 - at / 10) + '% + 10px)';
  });
  area.addEventListener('pointerleave', function () { if (lines) cursor.style.display = box.style.display = 'none'; });
});
