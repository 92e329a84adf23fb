// How the light of a turning object repeats: power against period above, the curve folded below.

const turning = report.turning;

/// The pass that is folded: the one shown, or of all the one with most epochs that has a periodogram.
function turningPass() {
  const found = shownPasses().map((pass) => ({ pass, bands: (turning.passes.find((one) => one.pass === pass.id) || { bands: [] }).bands }))
    .filter((one) => one.bands.some(Boolean));
  return found.sort((a, b) => b.pass.rows.length - a.pass.rows.length)[0] || null;
}

/// The period to fold at: of the strongest peak (of the middle band, else of the first that has one), twice that, or one of the law's.
function foldPeriod(state, one) {
  const best = (one.bands[middleBand] || one.bands.find(Boolean)).best;
  return state.period === "found" ? best : state.period === "twice" ? 2 * best : turning.periods[Number(state.period)].seconds;
}

/// Magnitude at one range, less its trend, against the turn; limits and dark epochs left out.
function foldedPoints(one, b, period) {
  const own = one.bands[b], band = bands[b];
  if (!own) return { x: [], y: [], row: [] };
  const start = milliseconds(own.start);
  const rows = one.pass.rows.filter((i) => band.intensity[i] > 0 && !band.mag_limit[i]);
  const seconds = rows.map((i) => (clock[i] - start) / 1000);
  return {
    row: rows, x: seconds.map((t) => ((t / period) % 1 + 1) % 1),
    y: rows.map((i, k) => {
      const x = seconds[k] / own.span_s;
      return -2.5 * Math.log10(band.intensity[i]) - (own.trend[0] + x * (own.trend[1] + x * own.trend[2]));
    }),
  };
}

const secondsText = (value) => value.toPrecision(4).replace(/\.?0+$/, "") + " s";

function periodMarks(one, plan, reach) {
  const theme = themeColours();
  const called = (period, share) => share === 1 ? plain(period.name) + ", " : turning.periods.length > 1 ? "½: " : "½ " + plain(period.name) + (isNarrow() ? ",<br>" : ", ");
  turning.periods.forEach((period, k) => [1, 0.5].forEach((share) => {
    const at = Math.log10(share * period.seconds);
    if (at < Math.log10(reach[0]) || at > Math.log10(reach[1])) return;
    // Light peaks a little beside half the spin: what half it is stands on the side of shorter periods, away from the line of the whole.
    const along = (at - Math.log10(reach[0])) / Math.log10(reach[1] / reach[0]);
    const side = along > (share === 1 ? 0.5 : 0.3) ? "right" : "left";
    plan.shapes.push({ type: "line", xref: "x", yref: "y domain", x0: share * period.seconds, x1: share * period.seconds, y0: 0, y1: 1, line: { color: theme.soft, width: 1, dash: share === 1 ? "dash" : "dot" } });
    plan.annotations.push({ x: at, y: 1 - 0.13 * (2 * k + (share === 1 ? 0 : 1)), xref: "x", yref: "y domain", text: called(period, share) + secondsText(share * period.seconds),
      showarrow: false, xanchor: side, xshift: side === "right" ? -6 : 6, yanchor: "top", align: side, font: { size: isNarrow() ? 10 : 11, color: theme.text }, bgcolor: theme.card, borderpad: 1 });
  }));
}

const turningFigure = turning && {
  id: "turning", title: "How the light repeats", height: () => isNarrow() ? 520 : 560,
  controls: [{ key: "period", name: "Fold at", options: [["found", "peak"], ["twice", "twice the peak"], ...turning.periods.map((one, k) => [String(k), one.name])] }],
  caption: "Lomb-Scargle power of the magnitude at one range, less a parabola in time, and the same magnitudes against the turn. "
    + "Dashed: the attitude's own period; dotted: half of it. The light repeats with what observer and Sun see of the turn (synodic): a spin shows "
    + "beside its own period as the bisector of Sun and observer moves, and at half of it where two sides are alike.",
  build: (state) => {
    const one = turningPass();
    const plan = layout({ hovermode: "closest", shapes: [], annotations: [], margin: { l: isNarrow() ? 52 : 60, r: isNarrow() ? 10 : 18, t: 8, b: 44 } });
    if (!one) {
      plan.annotations.push({ text: "No pass here has the twelve lit epochs that this needs.", xref: "paper", yref: "paper", x: 0.5, y: 0.5, showarrow: false });
      return { data: [], layout: { ...plan, xaxis: { visible: false }, yaxis: { visible: false } } };
    }
    const period = foldPeriod(state, one), data = [];
    const reach = range(one.bands.flatMap((own) => own ? [own.period[0], own.period[own.period.length - 1]] : []));
    byWavelength.filter((b) => one.bands[b]).forEach((b) => {
      const own = one.bands[b], band = bands[b], points = foldedPoints(one, b, period);
      data.push({ type: "scatter", mode: "lines", x: own.period, y: own.power, name: plain(band.label), legendgroup: band.name,
        line: { color: band.colour, width: 1.4, dash: band.dash }, hovertemplate: "%{x:.4g} s: %{y:.3f}<extra>" + plain(band.label) + "</extra>" });
      data.push({ type: "scatter", mode: "markers", x: points.x, y: points.y, text: points.row.map((i) => epochs.time[i]), xaxis: "x2", yaxis: "y2",
        legendgroup: band.name, showlegend: false, marker: { color: band.colour, symbol: band.symbol, size: 4, opacity: 0.75 },
        hovertemplate: "%{y:.3f} mag at %{x:.3f} of a turn<br>%{text}<extra>" + plain(band.label) + "</extra>" });
    });
    periodMarks(one, plan, reach);
    Object.assign(plan, {
      xaxis: axis({ title: "period [s]", type: "log", range: reach.map(Math.log10), anchor: "y", dtick: reach[1] > 300 * reach[0] ? 1 : "D2", tickformat: "~g" }),
      yaxis: axis({ title: "power", domain: [0.6, 1], rangemode: "tozero" }),
      xaxis2: axis({ title: "turns of " + secondsText(period) + " (pass " + one.pass.label + ")", anchor: "y2", range: [0, 1] }),
      yaxis2: axis({ title: "mag less trend", domain: [0, 0.42], autorange: "reversed" }),
    });
    return { data, layout: plan };
  },
  table: (state) => {
    const one = turningPass(), period = one ? foldPeriod(state, one) : 0, rows = [];
    if (one) bands.forEach((band, b) => {
      const points = foldedPoints(one, b, period);
      points.row.forEach((i, k) => rows.push([epochs.time[i], one.pass.id, band.name, period, points.x[k], points.y[k]]));
    });
    return { columns: [["time_utc", ""], ["pass_id", ""], ["band", ""], ["period", "s"], ["turn", ""], ["mag_less_trend", "mag"]].map(([name, unit]) => ({ name, unit })), rows };
  },
};
