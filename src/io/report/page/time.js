// Figures against time: one panel per pass, bands on top of each other, marks for what has no light.

const eventKinds = [
  { name: "dark", symbol: "square", colour: "#7f8794", at: (row) => epochs.dark[row] === 1 },
  { name: "umbra", symbol: "diamond", colour: "#5b6fae", at: (row) => epochs.sunlit[row] <= 0 },
  { name: "glint", symbol: "star", colour: "#e69f00", at: (row) => epochs.glint[row] === 1 },
];

/// Parts of the width for the shown passes, by duration, none narrower than a sixth of an equal share.
function panelDomains(shown) {
  const least = 0.16 / shown.length;
  const spans = shown.map((pass) => Math.max(1, clock[pass.rows[pass.rows.length - 1]] - clock[pass.rows[0]]));
  const total = spans.reduce((a, b) => a + b, 0);
  const shares = spans.map((span) => Math.max(least, span / total));
  const sum = shares.reduce((a, b) => a + b, 0);
  const gap = shown.length > 1 ? 0.03 : 0;
  let at = 0;
  return shares.map((share) => {
    const width = share / sum * (1 - gap * (shown.length - 1));
    const domain = [at, Math.min(1, at + width)];
    at += width + gap;
    return domain;
  });
}

/// The day under a panel, as long as it fits; one day for all stands under the widest alone.
function panelTitle(shown, k, width) {
  const isOneDay = shown.every((pass) => pass.day === shown[0].day);
  const spans = shown.map((pass) => clock[pass.rows[pass.rows.length - 1]] - clock[pass.rows[0]]);
  if (isOneDay) return k === spans.indexOf(Math.max(...spans)) ? shown[k].day + " UTC" : "";
  const room = width * (isNarrow() ? 300 : 620); // letters of 7 pixels, about
  return room > 110 ? shown[k].day + " UTC" : room > 45 ? shown[k].day.slice(5) : "";
}

function timeAxes(shown, plan) {
  const domains = panelDomains(shown);
  const theme = themeColours();
  shown.forEach((pass, k) => {
    const first = clock[pass.rows[0]], last = clock[pass.rows[pass.rows.length - 1]];
    const pad = Math.max(500, 0.02 * (last - first));
    const iso = (t) => new Date(t).toISOString().replace("T", " ").replace("Z", "");
    const marks = Math.max(1, Math.round((isNarrow() ? 5 : 9) * (domains[k][1] - domains[k][0])));
    plan["xaxis" + (k ? k + 1 : "")] = axis({
      type: "date", domain: domains[k], anchor: "y", title: panelTitle(shown, k, domains[k][1] - domains[k][0]),
      range: [iso(first - pad), iso(last + pad)], tickformat: last - first + 2 * pad < 30000 * marks ? "%H:%M:%S" : "%H:%M", // at a minute or more
      hoverformat: "%H:%M:%S", nticks: marks,
      showticklabels: domains[k][1] - domains[k][0] > (isNarrow() ? 0.2 : 0.09),
      showline: true, tickangle: 0, zeroline: false,
    });
    if (k > 0) // a line between panels that are not next to each other in time
      plan.shapes.push({ type: "line", xref: "paper", yref: "paper", x0: domains[k][0] - 0.015, x1: domains[k][0] - 0.015,
        y0: 0, y1: 1, line: { color: theme.line, width: 1, dash: "dot" } });
  });
}

/// Marks under the curves for dark, umbra and glint epochs; returns the height they take.
function eventTraces(shown, data, plan) {
  const present = eventKinds.filter((kind) => shown.some((pass) => pass.rows.some(kind.at)));
  if (!present.length) return 0;
  const height = 0.035 * present.length + 0.02;
  present.forEach((kind, level) => shown.forEach((pass, k) => {
    const rows = pass.rows.filter(kind.at);
    data.push({
      type: "scatter", mode: "markers", x: rows.map((row) => times[row]), y: rows.map(() => present.length - level),
      xaxis: "x" + (k ? k + 1 : ""), yaxis: "y9", name: kind.name, legendgroup: kind.name, legendrank: 2000,
      showlegend: k === shown.findIndex((other) => other.rows.some(kind.at)),
      marker: { symbol: kind.symbol, color: kind.colour, size: 7 }, hovertemplate: "%{x}<extra>" + kind.name + "</extra>",
    });
  }));
  plan.yaxis9 = { domain: [0, height], range: [0.4, present.length + 0.6], visible: false, fixedrange: true };
  return height;
}

/// Magnitudes from the faint end of the axis to the bright one: 12 below the brightest at most, so that the far
/// tail of a lobe leaves the curve its height. Null where nothing is known.
function magnitudeSpan(shown) {
  const rows = shown.flatMap((pass) => pass.rows);
  const known = range(rows.flatMap((i) => bands.map((band) => band.mag_limit[i] ? null : band.mag[i])));
  if (!known) return null;
  const faint = Math.min(known[1], known[0] + 12), pad = Math.max(0.1, 0.05 * (faint - known[0]));
  return [faint + pad, known[0] - pad];
}

/// What an axis in percent reaches: all values, and of their errors those that are no wider than the curve is high. One
/// stretch of light too faint to be known would else flatten all the rest.
const percentSpan = (name, least = -Infinity) => (shown) => {
  const values = [], ends = [];
  for (const i of shown.flatMap((pass) => pass.rows))
    for (const band of bands) {
      values.push(percent(band[name][i]));
      const ends_of = within(percent(band[name][i]), percent(band[name + "_err"][i]), least);
      if (ends_of) ends.push(ends_of);
    }
  const known = range(values);
  if (!known) return null;
  const high = Math.max(known[1] - known[0], 1);
  const all = range([...known, ...ends.filter((one) => one[1] - one[0] <= high).flat()]);
  const pad = Math.max(0.05 * (all[1] - all[0]), 0.05);
  return [all[0] - pad, all[1] + pad];
};

/// Triangles that point to where the object is: limits, and what is fainter than the axis reaches.
function limitTraces(pass, k, curve, key, edge, data) {
  const rows = pass.rows.filter((i) => curve.value(i) !== null && (curve.isLimit(i) || curve.value(i) > edge));
  if (!rows.length) return;
  data.push({
    type: "scatter", mode: "markers", x: rows.map((i) => times[i]), y: rows.map((i) => Math.min(curve.value(i), edge)), cliponaxis: false,
    customdata: rows.map((i) => (curve.isLimit(i) ? "> " : "") + curve.value(i).toFixed(2)),
    xaxis: "x" + (k ? k + 1 : ""), yaxis: "y" + key, name: plain(curve.name), legendgroup: curve.name, showlegend: false,
    marker: { color: curve.colour, symbol: "triangle-down-open", size: 7 }, hovertemplate: "%{customdata} mag",
  });
}

/// Bands behind a curve (`bounds` of each row), one outline per stretch of neighbouring values; an angle that goes
/// round begins another.
function outlineTraces(pass, k, curve, bounds, opacity, key, data, isCyclic) {
  const x = [], y = [];
  for (const run of pass.runs) {
    let part = [];
    const close = () => {
      if (part.length > 1) {
        const back = [...part].reverse();
        x.push(...part.map((i) => times[i]), ...back.map((i) => times[i]), null);
        y.push(...part.map((i) => bounds(i)[0]), ...back.map((i) => bounds(i)[1]), null);
      }
      part = [];
    };
    for (const i of run) {
      const isKnown = curve.at(i) !== null && bounds(i);
      if (!isKnown || (isCyclic && part.length && Math.abs(curve.at(i) - curve.at(part[part.length - 1])) > 90)) close();
      if (isKnown) part.push(i);
    }
    close();
  }
  if (x.length) data.push({
    type: "scatter", mode: "lines", x, y, fill: "toself", fillcolor: faint(curve.colour, opacity), line: { width: 0 }, hoverinfo: "skip",
    xaxis: "x" + (k ? k + 1 : ""), yaxis: "y" + key, name: plain(curve.name), legendgroup: curve.name, showlegend: false,
  });
}

/// Value and half-width as two bounds; on a logarithmic axis the lower one stays above a thousandth of the value.
const within = (value, error, least = -Infinity, most = Infinity) => value === null || error === null || !(error > 0) ? null
  : [Math.max(least, value - error), Math.min(most, value + error)];
const withinFactor = (value, magError) => value === null || magError === null || !(magError > 0) ? null
  : [Math.max(1e-3 * value, value * (2 - 10 ** (0.4 * magError))), value * 10 ** (0.4 * magError)];

/// From [materials] vary: what a value becomes over the ranges of haze, in the units of its axis.
const spreadOf = (band, row, i) => {
  const low = band[row.spread + "_low"][i], high = band[row.spread + "_high"][i];
  return low === null || high === null ? null : [low * (row.factor || 1), high * (row.factor || 1)];
};
const hasSpread = bands.some((band) => band.mag_low);
const spreadText = hasSpread ? " Wider and paler: what the stated ranges of the materials' haze make of it." : "";

/// Rows of panels from `rows`: {title, at(band, row), bounds(band, row), cyclic, type, reversed, range, dtick, digits, unit,
/// span, isLimit}, of the bands that `state` chooses.
function timeFigure(rows, state = {}) {
  const shown = shownPasses();
  const data = [];
  const plan = layout({ hovermode: "x unified", shapes: [] });
  timeAxes(shown, plan);
  const floor = eventTraces(shown, data, plan);
  const gap = 0.05;
  const height = (1 - floor - (floor ? 0.02 : 0) - gap * (rows.length - 1)) / rows.length;
  rows.forEach((row, r) => {
    const span = row.span ? row.span(shown) : row.range;
    const top = 1 - r * (height + gap);
    const key = r ? r + 1 : "";
    plan["yaxis" + key] = axis({
      title: row.title, domain: [Math.max(0, top - height), top], type: row.type || "linear",
      autorange: span ? false : row.reversed ? "reversed" : true, ...(span ? { range: span } : {}),
      ...(row.dtick ? { dtick: row.dtick } : {}), ...(row.type === "log" ? { exponentformat: "power" } : {}),
    });
    const curves = row.curves || chosenBands(state).map((b) => bands[b]).map((band) => ({ name: band.label, colour: band.colour, symbol: band.symbol, dash: band.dash,
      bounds: row.bounds && ((i) => row.bounds(band, i)), spread: row.spread && band[row.spread + "_low"] && ((i) => spreadOf(band, row, i)), value: (i) => row.at(band, i),
      isLimit: (i) => row.isLimit ? row.isLimit(band, i) : false, at: (i) => row.isLimit && (row.isLimit(band, i) || (span && row.at(band, i) > span[0])) ? null : row.at(band, i) }));
    shown.forEach((pass, k) => curves.forEach((curve) => {
      if (row.isLimit) limitTraces(pass, k, curve, key, span ? span[0] - 0.02 * (span[0] - span[1]) : Infinity, data);
      if (curve.spread) outlineTraces(pass, k, curve, curve.spread, 0.13, key, data);
      if (curve.bounds) outlineTraces(pass, k, curve, curve.bounds, 0.22, key, data, row.cyclic);
      const line = (row.cyclic ? gappedCyclic : gapped)(pass, curve.at);
      data.push({
        type: "scatter", mode: "lines+markers", x: line.x, y: line.y, customdata: line.row.map((i) => epochs.phase[i]),
        xaxis: "x" + (k ? k + 1 : ""), yaxis: "y" + key, name: plain(curve.name), legendgroup: curve.name,
        showlegend: r === 0 && k === 0, connectgaps: false,
        line: { color: curve.colour, width: 1.6, dash: curve.dash || "solid" }, marker: { color: curve.colour, symbol: curve.symbol, size: 6, maxdisplayed: 24 },
        hovertemplate: "%{y:." + row.digits + "} " + (row.unit || "") + " (phase %{customdata:.1f}°)",
      });
    }));
  });
  // The lowest row carries the time axis, under the marks if there are any.
  for (let k = 0; k < shown.length; ++k)
    plan["xaxis" + (k ? k + 1 : "")].anchor = floor ? "y9" : "y" + (rows.length > 1 ? rows.length : "");
  return { data, layout: plan };
}

const brightnessRows = {
  mag: { title: report.mag_system + " magnitude", at: (band, i) => band.mag[i], reversed: true, digits: "2f", unit: "mag",
    bounds: (band, i) => within(band.mag[i], band.mag_err[i]), span: magnitudeSpan, isLimit: (band, i) => band.mag_limit[i] === 1, spread: "mag" },
  irradiance: { title: "I [W m⁻² nm⁻¹]", at: (band, i) => positive(band.irradiance[i]), bounds: (band, i) => withinFactor(positive(band.irradiance[i]), band.mag_err[i]), type: "log", digits: "3e" },
  intensity: { title: "intensity [m² sr⁻¹]", at: (band, i) => positive(band.intensity[i]), bounds: (band, i) => withinFactor(positive(band.intensity[i]), band.mag_err[i]), type: "log", digits: "3e", spread: "intensity" },
};

const skyNorth = { equatorial: "celestial north", altaz: "the local zenith", scattering: "the normal of the scattering plane" }[report.frame];

const timeFigures = [
  {
    id: "brightness", isAgainstTime: true, title: "Brightness against time", height: () => isNarrow() ? 340 : 460,
    controls: [{ key: "scale", name: "Show", options: [["mag", "magnitude"], ["irradiance", "irradiance"], ["intensity", "intensity"]] }, bandControl],
    caption: "Magnitude and irradiance above the atmosphere; intensity without distance, eclipse and solar flux. Shaded behind curves, here and below: numerical 95 % half-widths, often thinner than the line." + spreadText + " Triangles: fainter than the point, or than the axis reaches. Marks below the curves, in all figures against time: dark (nothing is both lit and seen, so q and u are undefined), umbra (in the Earth's shadow), glint. Lines break there and between passes.",
    build: (state) => timeFigure([brightnessRows[state.scale]], state),
    table: () => tidyTable([["mag", "mag", (b, i) => b.mag[i]], ["mag_err", "mag", (b, i) => b.mag_err[i]], ["mag_limit", "", (b, i) => b.mag_limit[i] ? "True" : "False"], ...(hasSpread ? [["mag_low", "mag", (b, i) => b.mag_low[i]], ["mag_high", "mag", (b, i) => b.mag_high[i]]] : []), ["I", "W m-2 nm-1", (b, i) => b.irradiance[i]],
      ["intensity", "m2 sr-1", (b, i) => b.intensity[i]]]),
  },
  {
    id: "qu", isAgainstTime: true, title: "q and u against time", height: () => isNarrow() ? 400 : 460, controls: [bandControl],
    caption: "Fractions of I in percent, in the sky frame: +q towards " + skyNorth + ", +u 45° from it.",
    build: (state) => timeFigure([
      { title: "q [%]", at: (band, i) => percent(band.q[i]), bounds: (band, i) => within(percent(band.q[i]), percent(band.q_err[i]), -100, 100), span: percentSpan("q"), digits: "2f", unit: "%" },
      { title: "u [%]", at: (band, i) => percent(band.u[i]), bounds: (band, i) => within(percent(band.u[i]), percent(band.u_err[i]), -100, 100), span: percentSpan("u"), digits: "2f", unit: "%" }], state),
    table: () => tidyTable([["q", "", (b, i) => b.q[i]], ["q_err", "", (b, i) => b.q_err[i]], ["u", "", (b, i) => b.u[i]], ["u_err", "", (b, i) => b.u_err[i]]]),
  },
  {
    id: "p_pa", isAgainstTime: true, title: "Degree and angle of linear polarization", height: () => isNarrow() ? 400 : 460, controls: [bandControl],
    caption: "p in percent; position angle in [0°, 180°) from " + skyNorth + ". The angle is cyclic: no line joins 180° to 0°.",
    build: (state) => timeFigure([
      { title: "p [%]", at: (band, i) => percent(band.p[i]), bounds: (band, i) => within(percent(band.p[i]), percent(band.p_err[i]), 0, 100), span: percentSpan("p", 0), spread: "p", factor: 100, digits: "2f", unit: "%" },
      { title: "angle [°]", at: (band, i) => band.pa[i], cyclic: true, range: [0, 180], dtick: 45, digits: "1f", unit: "°",
        bounds: (band, i) => within(band.pa[i], band.pa_err[i], 0, 180) }], state),
    table: () => tidyTable([["p", "", (b, i) => b.p[i]], ["p_err", "", (b, i) => b.p_err[i]], ["pa", "deg", (b, i) => b.pa[i]], ["pa_err", "deg", (b, i) => b.pa_err[i]]]),
  },
];

/// What light of more than one surface does to each Stokes parameter, in percent of I.
const indirectPart = (part) => (band, i) => percent(band["indirect_" + part][i]);
const indirectFigure = {
  id: "indirect", isAgainstTime: true, title: "Light between surfaces", height: () => isNarrow() ? 420 : 520,
  caption: "Part of I, Q, U and V from light that touched more than one surface, in percent of the whole I, up to " +
    report.bounces + " surfaces. Q and U in the scattering frame: +Q perpendicular to the plane of Sun, object and observer.",
  build: () => timeFigure([["i", "I"], ["q", "Q"], ["u", "U"], ["v", "V"]].map(([part, name]) =>
    ({ title: name + " [%]", at: indirectPart(part), digits: "2f", unit: "%" }))),
  table: () => tidyTable(["i", "q", "u", "v"].map((part) => ["indirect_" + part, "", (b, i) => b["indirect_" + part][i]])),
};

/// Differences of magnitude between neighbouring bands.
const colourPairs = byWavelength.slice(1).map((long, k) => ({
  name: bands[byWavelength[k]].label + " − " + bands[long].label, short: bands[byWavelength[k]], long: bands[long],
  colour: manyBandColours[(2 * k) % 7], symbol: symbols[k % symbols.length],
}));
const isMagnitude = (band, i) => band.mag[i] !== null && !band.mag_limit[i];
const colourIndex = (pair, i) => !isMagnitude(pair.short, i) || !isMagnitude(pair.long, i) ? null : pair.short.mag[i] - pair.long.mag[i];
const colourFigure = {
  id: "colour", isAgainstTime: true, title: "Colour index against time", height: () => isNarrow() ? 320 : 460,
  caption: "Shorter minus longer wavelength, " + report.mag_system + " magnitudes: larger is redder.",
  build: () => timeFigure([{ title: "colour [mag]", digits: "3f", unit: "mag",
    // Rounding keeps a constant colour a straight line instead of a plot of the last bits.
    curves: colourPairs.map((pair) => ({ name: pair.name, colour: pair.colour, symbol: pair.symbol,
      at: (i) => colourIndex(pair, i) === null ? null : Math.round(colourIndex(pair, i) * 1e6) / 1e6 })) }]),
  table: () => ({
    columns: [{ name: "time_utc", unit: "" }, { name: "pass_id", unit: "" }, ...colourPairs.map((pair) => ({ name: pair.name.replace("−", "minus"), unit: "mag" }))],
    rows: shownRows().map((i) => [epochs.time[i], epochs.pass[i], ...colourPairs.map((pair) => colourIndex(pair, i))]),
  }),
};

const contributions = report.contributions.filter((c) => c.intensity.length);

/// Parts of a run where the object gives light in that band.
function litRuns(pass, band) {
  const out = [];
  for (const run of pass.runs) {
    let open = false;
    for (const row of run) {
      const lit = bands[band].intensity[row] > 0;
      if (lit && !open) out.push([]);
      if (lit) out[out.length - 1].push(row);
      open = lit;
    }
  }
  return out;
}

const contributionFigure = {
  id: "contribution", isAgainstTime: true, title: "Contribution per material", height: () => isNarrow() ? 360 : 460,
  controls: [
    { key: "band", name: "Band", options: byWavelength.map((b) => [b, bands[b].label]) },
    { key: "scale", name: "Show", options: [["share", "share"], ["intensity", "intensity"]] }],
  caption: "Reflected light of each material, stacked; share of the intensity in percent or absolute.",
  build: (state) => {
    const shown = shownPasses();
    const data = [];
    const plan = layout({ hovermode: "x unified", shapes: [] });
    timeAxes(shown, plan);
    const floor = eventTraces(shown, data, plan);
    const isShare = state.scale === "share";
    plan.yaxis = axis({ title: isShare ? "share of I [%]" : "intensity [m² sr⁻¹]", domain: [floor ? floor + 0.02 : 0, 1], ...(isShare ? { range: [0, 100] } : { rangemode: "tozero" }) });
    if (floor) shown.forEach((_, k) => { plan["xaxis" + (k ? k + 1 : "")].anchor = "y9"; });
    let stack = 0;
    shown.forEach((pass, k) => litRuns(pass, state.band).forEach((run) => {
      ++stack; // every run is a stack of its own, so that no area spans a gap
      contributions.forEach((part) => data.push({
        type: "scatter", mode: run.length === 1 ? "markers" : "lines", stackgroup: "stack" + stack, x: run.map((i) => times[i]),
        y: run.map((i) => part.intensity[state.band][i] * (isShare ? 100 / bands[state.band].intensity[i] : 1)),
        xaxis: "x" + (k ? k + 1 : ""), yaxis: "y", name: plain(part.material), legendgroup: part.material, showlegend: stack === 1,
        line: { width: 0.5, color: part.colour }, fillcolor: part.colour,
        hovertemplate: isShare ? "%{y:.1f} %" : "%{y:.3e}",
      }));
    }));
    return { data, layout: plan };
  },
  table: () => {
    const rows = [];
    for (const i of shownRows())
      bands.forEach((band, b) => contributions.forEach((part) => rows.push([epochs.time[i], epochs.pass[i], band.name, part.material, part.intensity[b][i]])));
    return { columns: [["time_utc", ""], ["pass_id", ""], ["band", ""], ["material", ""], ["intensity", "m2 sr-1"]].map(([name, unit]) => ({ name, unit })), rows };
  },
};
