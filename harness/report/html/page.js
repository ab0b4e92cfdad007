// Shows and hides methods in the plots, changes axes, and says what a point is. Without it the page stands as it is.
(() => {
  'use strict';
  const data = JSON.parse(document.getElementById('report-data').textContent);
  const plots = new Map(data.plots.map((plot) => [plot.id, plot]));
  const near = 14;  // units of a plot's picture
  document.documentElement.classList.add('js');

  document.addEventListener('change', (event) => {
    const {log, toggle, set} = event.target.dataset;
    if (log !== undefined) {
      document.getElementById(log).classList.toggle('log', event.target.checked);
    } else if (toggle !== undefined) {
      for (const part of document.getElementById(set + '-plots').querySelectorAll('svg [data-toggle]')) {
        if (part.dataset.toggle === toggle) part.classList.toggle('off', !event.target.checked);
      }
    }
  });
  // A browser keeps what was ticked when the page is loaded again.
  document.querySelectorAll('input[data-log], input[data-toggle]').forEach((input) => { input.checked = input.defaultChecked; });

  const number = (value) => {
    const size = Math.abs(value);
    if (size >= 1e9) return +(value / 1e9).toPrecision(3) + 'G';
    if (size >= 1e6) return +(value / 1e6).toPrecision(3) + 'M';
    if (size >= 1e4) return +(value / 1e3).toPrecision(3) + 'k';
    return size < 1e-9 ? '0' : String(+value.toPrecision(4));
  };
  // From a value to its place, as the page says of an axis.
  const placing = (numbers) => {
    const [low, high, begin, end, logarithmic] = numbers.split(' ').map(Number);
    return (value) => {
      const scaled = !logarithmic ? value : value > 0 ? Math.log10(value) : low;
      return begin + Math.min(1, Math.max(0, (scaled - low) / (high - low))) * (end - begin);
    };
  };
  const hidden = (svg, toggle) => [...svg.querySelectorAll('.off')].some((part) => part.dataset.toggle === toggle);

  // The mark of a plot that is nearest to a point of its picture.
  const nearest = (plot, svg, x, y) => {
    const [placeX, placeY] = [placing(svg.dataset.x), placing(svg.dataset.y)];
    let best = null;
    let least = near;
    for (const series of plot.series) {
      if (series.color < 0 || hidden(svg, series.toggle)) continue;  // a front or target is no setting
      for (const mark of series.marks) {
        if (typeof mark[0] !== 'number' || typeof mark[1] !== 'number') continue;
        const way = Math.hypot(placeX(mark[0]) - x, placeY(mark[1]) - y);
        if (way < least) [least, best] = [way, (mark[2] || series.name) + ': ' + number(mark[0]) + ', ' + number(mark[1])];
      }
    }
    return best;
  };

  const tip = document.createElement('div');
  tip.className = 'tip';
  tip.hidden = true;
  document.body.append(tip);
  document.addEventListener('pointermove', (event) => {
    const svg = event.target.closest && event.target.closest('.plot > svg[data-x]');
    let words = null;
    if (svg) {
      const at = new DOMPoint(event.clientX, event.clientY).matrixTransform(svg.getScreenCTM().inverse());
      words = nearest(plots.get(svg.parentElement.id), svg, at.x, at.y);
    }
    tip.hidden = words === null;
    if (tip.hidden) return;
    tip.textContent = words;
    tip.style.left = Math.min(event.pageX + 12, document.documentElement.clientWidth - tip.offsetWidth - 4) + 'px';
    tip.style.top = event.pageY + 14 + 'px';
  });
})();
