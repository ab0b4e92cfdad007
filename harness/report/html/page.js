// Draws the plots that the page describes in #report-data, in place of their static pictures. Without this script, or
// without Chart.js, the page stands as it is.
(() => {
  'use strict';
  if (typeof Chart === 'undefined') return;
  const root = document.documentElement;
  const plots = JSON.parse(document.getElementById('report-data').textContent).plots;
  const dashes = [[], [7, 3], [2, 3], [9, 3, 2, 3]];
  const shapes = ['circle', 'rect', 'rectRot', 'triangle'];
  const faint = [1, 0.72, 0.5, 0.32];
  const drawn = new Map();  // id of a plot: {plot, chart, logarithmic}
  const hidden = new Map();  // id of a section's set: the methods that are hidden

  const theme = () => {
    const style = getComputedStyle(root);
    const color = (name) => style.getPropertyValue(name).trim();
    const series = [];
    while (color('--c' + series.length) !== '') series.push(color('--c' + series.length));
    return {
      ink: color('--ink'), soft: color('--soft'), grid: color('--grid'), panel: color('--panel'),
      series,
    };
  };
  let colors = theme();

  const faded = (hex, alpha) => hex + Math.round(alpha * 255).toString(16).padStart(2, '0');
  const number = (value) => value === 'inf' ? Infinity : value === null || value === undefined ? NaN : value;
  const tick = (value) => {
    const size = Math.abs(value);
    if (size >= 1e9) return +(value / 1e9).toPrecision(3) + 'G';
    if (size >= 1e6) return +(value / 1e6).toPrecision(3) + 'M';
    if (size >= 1e4) return +(value / 1e3).toPrecision(3) + 'k';
    return size < 1e-9 ? '0' : String(+value.toPrecision(4));
  };
  const setOf = (plot) => plot.id.split('-')[0];
  const isHidden = (plot, toggle) => toggle !== '' && (hidden.get(setOf(plot)) || new Set()).has(toggle);

  // Ticks of a logarithmic axis: 1, 2 and 5 of each decade where there are few; else of each n-th the 1.
  const logTicks = (axis) => {
    const low = Math.log10(axis.min);
    const high = Math.log10(axis.max);
    const ticks = [];
    for (let decade = Math.floor(low); decade <= high; decade += Math.max(1, Math.ceil((high - low) / 8))) {
      for (const digit of high - low < 3 ? [1, 2, 5] : [1]) {
        const place = decade + Math.log10(digit);
        if (place >= low && place <= high) ticks.push({value: digit * Math.pow(10, decade)});
      }
    }
    axis.ticks = ticks;
  };
  const scale = (title, logarithmic, more) => Object.assign({
    type: logarithmic ? 'logarithmic' : 'linear',
    afterBuildTicks: logarithmic ? logTicks : undefined,
    title: {display: true, text: title, color: colors.ink, font: {size: 12.5}},
    grid: {color: colors.grid, borderColor: colors.grid},
    ticks: {color: colors.soft, font: {size: 12}, maxRotation: 0, callback: tick},
  }, more);
  const options = (more) => Object.assign({
    animation: false, responsive: true, maintainAspectRatio: false, normalized: true,
  }, more);

  // An axis that counts has whole ticks, and ends with the last.
  const counting = (plot) => ({
    max: Math.max(...plot.series.flatMap((s) => s.marks.map((m) => m[0]))),
    afterBuildTicks: (axis) => { axis.ticks = axis.ticks.filter((t) => Number.isInteger(t.value)); },
  });
  const curves = (plot, logarithmic) => {
    const marks = (series) => series.marks.filter((mark) => typeof mark[0] === 'number' && typeof mark[1] === 'number');
    // What is not positive has no place on a logarithmic axis: it stands at its beginning.
    const least = (k) => Math.min(...plot.series.flatMap((s) => marks(s).map((m) => m[k])).filter((v) => v > 0));
    const floors = [least(0) / 2, least(1) / 2];
    // The values and a margin; whole decades would leave most of a plot empty.
    const span = (k) => {
      const values = plot.series.flatMap((s) => marks(s).map((m) => place(m[k], k)));
      return {min: Math.min(...values) / 1.3, max: Math.max(...values) * 1.3};
    };
    const isLogarithmic = (k) => logarithmic && !(k === 0 && plot.counts);
    const place = (value, k) => isLogarithmic(k) && !(value > 0) ? floors[k] : value;
    const tooltip = (item) => {
      const mark = item.raw.mark;
      return (mark[2] || item.dataset.label) + ': ' + tick(mark[0]) + ', ' + tick(mark[1]);
    };
    return {
      type: 'scatter',
      data: {
        datasets: plot.series.map((series) => {
          const color = series.color < 0 ? colors.ink : colors.series[series.color];
          const points = marks(series);
          return {
            label: series.name, hidden: isHidden(plot, series.toggle), showLine: series.joined,
            data: points.map((mark) => ({x: place(mark[0], 0), y: place(mark[1], 1), mark})),
            borderColor: color, backgroundColor: color, borderDash: dashes[series.variant],
            borderWidth: series.color < 0 ? 1.2 : 1.8, clip: 8, pointStyle: shapes[series.shape % 4],
            pointRadius: series.dots ? 4 : 0, pointHitRadius: series.color < 0 ? 0 : 8,
            pointBorderColor: points.map((mark) => mark[3] ? colors.ink : color),
            pointBorderWidth: points.map((mark) => mark[3] ? 2 : 0),
          };
        }),
      },
      options: options({
        interaction: {mode: 'nearest', intersect: true},
        layout: {padding: {right: 8}},
        scales: {
          x: scale(plot.x, isLogarithmic(0), plot.counts ? counting(plot) : logarithmic ? span(0) : {beginAtZero: true, grace: '5%'}),
          y: scale(plot.y, logarithmic, logarithmic ? span(1) : {beginAtZero: true, grace: '4%'}),
        },
        plugins: {
          legend: {display: false},
          tooltip: {callbacks: {label: tooltip, title: (items) => plot.counts && items.length
              ? plot.x + ' ' + items[0].raw.mark[0] : ''}},
        },
      }),
    };
  };

  // Whiskers, the value behind each bar, and the line that bars are held against.
  const barMarks = (plot) => ({
    id: 'barMarks',
    afterDatasetsDraw(chart) {
      const {ctx, chartArea, scales} = chart;
      const at = (value) => Math.min(chartArea.right, Math.max(chartArea.left, scales.x.getPixelForValue(value)));
      ctx.save();
      ctx.font = '11px system-ui, sans-serif';
      ctx.textBaseline = 'middle';
      chart.data.datasets.forEach((dataset, d) => {
        chart.getDatasetMeta(d).data.forEach((bar, i) => {
          const mark = dataset.marks[i];
          if (!mark || chart.data.hiddenRows[i]) return;
          let end = number(mark[0]) === Infinity ? chartArea.right - 14 : at(number(mark[0]));
          if (mark.length > 4 && mark[5] > mark[4]) {
            ctx.strokeStyle = colors.ink;
            ctx.lineWidth = 1.2;
            ctx.beginPath();
            ctx.moveTo(at(mark[4]), bar.y); ctx.lineTo(at(mark[5]), bar.y);
            for (const side of [4, 5]) { ctx.moveTo(at(mark[side]), bar.y - 2); ctx.lineTo(at(mark[side]), bar.y + 2); }
            ctx.stroke();
            end = Math.max(end, at(mark[5]));
          }
          ctx.fillStyle = colors.soft;
          ctx.fillText(mark[0] === 'inf' ? '∞' : tick(mark[0]), end + 5, bar.y);
        });
      });
      if (plot.reference !== undefined) {
        ctx.strokeStyle = colors.ink;
        ctx.lineWidth = 1.4;
        ctx.setLineDash([5, 3]);
        ctx.beginPath();
        ctx.moveTo(at(plot.reference), chartArea.top); ctx.lineTo(at(plot.reference), chartArea.bottom);
        ctx.stroke();
      }
      ctx.restore();
    },
  });

  const bars = (plot, logarithmic, width) => {
    const longest = width < 480 ? 16 : 30;
    // In the middle: settings of one method differ at the end.
    const head = longest >> 1;
    const shortened = (text) => text.length > longest ? text.slice(0, head) + '…' + text.slice(head + 1 - longest) : text;
    const shown = plot.categories.map((category) => !isHidden(plot, category.toggle));
    const finite = plot.series.flatMap((s) => s.marks.filter((m) => shown[m[1]]).flatMap((m) => [m[0], m[5]]))
        .filter((v) => typeof v === 'number');
    if (plot.reference !== undefined) finite.push(plot.reference);
    const most = Math.max(0, ...finite) || 1;  // none is left where all are hidden
    const least = Math.min(most, ...finite.filter((v) => v > 0));
    return {
      type: 'bar',
      data: {
        labels: plot.categories.map((category) => shortened(category.label)),
        hiddenRows: shown.map((s) => !s),
        datasets: plot.series.map((series) => {
          const marks = plot.categories.map((_, i) => series.marks.find((mark) => mark[1] === i));
          return {
            label: series.name, marks,
            data: marks.map((mark, i) => !mark || !shown[i] ? null : mark[0] === 'inf' ? most * 1.15 : mark[0]),
            backgroundColor: plot.categories.map((c) => faded(colors.series[c.color], faint[series.variant])),
            barPercentage: 0.9, categoryPercentage: 0.82,
          };
        }),
      },
      options: options({
        indexAxis: 'y',
        scales: {
          x: scale(plot.x, logarithmic, logarithmic ? {min: least / 2, max: most * 4} : {beginAtZero: true, suggestedMax: most * 1.16}),
          y: {grid: {display: false}, ticks: {color: colors.ink, font: {size: 12}, autoSkip: false}},
        },
        plugins: {
          legend: {display: false},
          tooltip: {callbacks: {
            title: (items) => items.length ? plot.categories[items[0].dataIndex].label : '',
            label: (item) => {
              const mark = item.dataset.marks[item.dataIndex];
              const span = mark.length > 4 ? ' (' + tick(mark[4]) + ' to ' + tick(mark[5]) + ')' : '';
              return item.dataset.label + ': ' + (mark[0] === 'inf' ? '∞' : tick(mark[0])) + span;
            },
          }},
        },
      }),
      plugins: [barMarks(plot)],
    };
  };

  const draw = (entry) => {
    if (entry.chart) entry.chart.destroy();
    const make = entry.plot.kind === 'bars' ? bars : curves;
    entry.chart = new Chart(entry.canvas, make(entry.plot, entry.logarithmic, entry.box.clientWidth));
  };
  const begin = (plot) => {
    const figure = document.getElementById(plot.id);
    if (!figure || drawn.has(plot.id)) return;
    const box = document.createElement('div');
    box.className = 'canvas-box';
    const canvas = document.createElement('canvas');
    canvas.setAttribute('role', 'img');
    canvas.setAttribute('aria-label', plot.title + ': ' + plot.y + ' against ' + plot.x);
    box.appendChild(canvas);
    figure.insertBefore(box, figure.querySelector('svg'));
    if (plot.kind === 'bars') {
      const bar = plot.series.length > 1 ? 13 : 18;
      box.style.height = 70 + plot.categories.length * (bar * plot.series.length + 8) + 'px';
    }
    figure.classList.add('drawn');
    const entry = {plot, canvas, box, chart: null, logarithmic: plot.log};
    drawn.set(plot.id, entry);
    draw(entry);
  };

  root.classList.add('js');
  // A plot is drawn when one comes near it.
  const byId = new Map(plots.map((plot) => [plot.id, plot]));
  if ('IntersectionObserver' in window) {
    const observer = new IntersectionObserver((entries) => {
      for (const entry of entries) {
        if (!entry.isIntersecting) continue;
        observer.unobserve(entry.target);
        begin(byId.get(entry.target.id));
      }
    }, {rootMargin: '600px'});
    for (const plot of plots) {
      const figure = document.getElementById(plot.id);
      if (figure) observer.observe(figure);
    }
  } else {
    plots.forEach(begin);
  }

  document.addEventListener('change', (event) => {
    const input = event.target;
    if (input.dataset.log !== undefined) {
      const plot = byId.get(input.dataset.log);
      if (!plot) return;
      begin(plot);
      const entry = drawn.get(plot.id);
      entry.logarithmic = input.checked;
      draw(entry);
    } else if (input.dataset.toggle !== undefined) {
      const set = hidden.get(input.dataset.set) || new Set();
      if (input.checked) set.delete(input.dataset.toggle); else set.add(input.dataset.toggle);
      hidden.set(input.dataset.set, set);
      for (const entry of drawn.values()) if (setOf(entry.plot) === input.dataset.set) draw(entry);
    }
  });
  // A browser keeps what was ticked when the page is loaded again.
  document.querySelectorAll('input[data-log], input[data-toggle]').forEach((input) => { input.checked = input.defaultChecked; });
  window.matchMedia('(prefers-color-scheme: dark)').addEventListener('change', () => {
    colors = theme();
    drawn.forEach(draw);
  });
})();
