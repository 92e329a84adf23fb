// Figures of one quantity against another: phase curves, q-u plane, colours in 3D, the sky.

const dashes = ["solid", "dash", "dot", "dashdot", "longdash", "longdashdot"];
const pureMaterials = [...new Set(report.pure_materials.map((curve) => curve.material))];

/// Points and lines of one band over the shown passes; `x` and `y` take a row.
function joined(x, y) {
  const out = { x: [], y: [], row: [] };
  shownPasses().forEach((pass) => pass.runs.forEach((run) => {
    for (const row of run) {
      out.x.push(x(row));
      out.y.push(y(row));
      out.row.push(row);
    }
    out.x.push(null);
    out.y.push(null);
    out.row.push(run[0]);
  }));
  return out;
}

/// Where the name of a pure-material curve stands: each material at its own phase angle, so that
/// names of like curves do not cover each other, or near it where neither values nor other names are.
function pureLabel(curve, m, shown, taken) {
  const share = (m + 0.5) / pureMaterials.length;
  const wanted = shown.x[0] + (0.39 + 0.33 * share) * (shown.x[1] - shown.x[0]);
  const seen = curve.phase.map((x, i) => ({ x, y: percent(curve.q_scat[i]) }))
    .filter((at) => at.y !== null && at.x >= shown.x[0] && at.x <= shown.x[1] && at.y >= shown.y[0] && at.y <= shown.y[1] - 0.1 * (shown.y[1] - shown.y[0])); // below the legend
  // A letter and a line of text in parts of the axes.
  const wide = (isNarrow() ? 0.02 : 0.013) * curve.material.length * (shown.x[1] - shown.x[0]), high = 0.055 * (shown.y[1] - shown.y[0]);
  const inside = (box, [x, y]) => x > box[0] && x < box[2] && y > box[1] && y < box[3];
  const placed = seen.map((at) => {
    const box = [at.x - wide / 2, at.y, at.x + wide / 2, at.y + high]; // it stands above its curve
    const covered = taken.points.filter((point) => inside(box, point)).length
      + 20 * taken.boxes.filter((one) => one[0] < box[2] && box[0] < one[2] && one[1] < box[3] && box[1] < one[3]).length;
    return { at, box, cost: covered + 12 * Math.abs(at.x - wanted) / (shown.x[1] - shown.x[0]) };
  });
  const best = placed.sort((a, b) => a.cost - b.cost)[0];
  if (best) taken.boxes.push(best.box);
  return best ? best.at : null;
}

/// What the axes of Q against phase reach: the object's own values with room about them, or all.
function phaseReach(state) {
  const x = range(shownRows().map((i) => epochs.phase[i]));
  const y = range(chosenBands(state).flatMap((b) => shownRows().map((i) => percent(bands[b].q_scat[i]))));
  if (state.reach === "all" || !x || !y) return { x: [0, 180], y: [-105, 105] };
  const wide = Math.max(10, 0.15 * (x[1] - x[0])), high = Math.max(1, 0.25 * (y[1] - y[0]));
  return { x: [Math.max(0, x[0] - wide), Math.min(180, x[1] + wide)], y: [Math.max(-105, y[0] - high), Math.min(105, y[1] + high)] };
}

function pureTraces(data, plan, shownBand, shown) {
  const theme = themeColours();
  const taken = { boxes: [], points: shownBand === "all" ? [] : shownRows().map((i) => [epochs.phase[i], percent(bands[shownBand].q_scat[i])]) };
  report.pure_materials.forEach((curve) => {
    if (shownBand !== "all" && curve.band !== shownBand) return;
    const m = pureMaterials.indexOf(curve.material);
    data.push({
      type: "scatter", mode: "lines", x: curve.phase, y: curve.q_scat.map(percent), name: plain(curve.material),
      legendgroup: "pure " + curve.material, showlegend: false, opacity: 0.55,
      line: { color: shownBand === "all" ? bands[curve.band].colour : theme.soft, dash: dashes[m % dashes.length], width: 1.2 },
      hovertemplate: "%{y:.1f} % at %{x}°<extra>" + plain(curve.material + " " + bands[curve.band].label) + "</extra>",
    });
    if (shownBand !== "all") {
      const at = pureLabel(curve, m, shown, taken);
      if (at) plan.annotations.push({ x: at.x, y: at.y, text: plain(curve.material), showarrow: false, yshift: 8, font: { size: 10, color: theme.soft }, bgcolor: theme.card, opacity: 0.85, borderpad: 1 });
    }
  });
  if (shownBand === "all") // one grey line per material explains the dashes
    pureMaterials.forEach((name, m) => data.push({
      type: "scatter", mode: "lines", x: [null], y: [null], name, legendgroup: "pure " + name, legendrank: 2000,
      line: { color: theme.soft, dash: dashes[m % dashes.length], width: 1.2 }, hoverinfo: "skip",
    }));
}

const phaseFigure = {
  id: "q_phase", title: "Q against phase angle", height: () => isNarrow() ? 420 : 460,
  controls: [bandControl, { key: "reach", name: "Axes", options: [["object", "this object"], ["all", "all there is"]].slice(0, pureMaterials.length ? 2 : 1) }],
  caption: "q_scat in percent, positive perpendicular to the scattering plane"
    + (pureMaterials.length ? "; thin lines behind: a surface of one material alone, single bounce, without body light. Most of them go beyond the axes of this object." : "."),
  build: (state) => {
    const data = [];
    const shown = phaseReach(state);
    const plan = layout({ annotations: [], hovermode: "closest",
      xaxis: axis({ title: "phase angle [°]", range: shown.x, nticks: isNarrow() ? 6 : 9 }), yaxis: axis({ title: "q_scat [%]", range: shown.y }) });
    pureTraces(data, plan, state.band, shown);
    chosenBands(state).forEach((b) => {
      const line = joined((i) => epochs.phase[i], (i) => percent(bands[b].q_scat[i]));
      data.push({
        type: "scatter", mode: "lines+markers", x: line.x, y: line.y, text: line.row.map((i) => epochs.time[i]), name: plain(bands[b].label),
        line: { color: bands[b].colour, width: 2, dash: bands[b].dash }, marker: { color: bands[b].colour, symbol: bands[b].symbol, size: 7, maxdisplayed: 40 },
        hovertemplate: "%{y:.2f} % at %{x:.2f}°<br>%{text}<extra>" + plain(bands[b].label) + "</extra>",
      });
    });
    return { data, layout: plan };
  },
  table: () => tidyTable([["q_scat", "", (b, i) => b.q_scat[i]], ["u_scat", "", (b, i) => b.u_scat[i]]]),
};

/// Limits of the phase colour map: the shown epochs.
function phaseAxis(extra) {
  const limits = range(shownRows().map((i) => epochs.phase[i])) || [0, 180];
  return { colorscale: phaseScale(), cmin: limits[0], cmax: limits[1], colorbar: colourBar("phase angle [°]", extra) };
}

/// Rows before the least phase angle of their pass, and those from it on: the night's two branches.
function phaseBranches(pass) {
  const least = pass.rows.reduce((best, i) => epochs.phase[i] < epochs.phase[best] ? i : best, pass.rows[0]);
  return [pass.rows.filter((i) => i < least), pass.rows.filter((i) => i >= least)];
}

const brightnessPhaseFigure = {
  id: "brightness_phase", title: "Brightness against phase angle", height: () => isNarrow() ? 380 : 460,
  controls: [{ key: "scale", name: "Show", options: [["mag", "magnitude"], ["intensity", "at one range"]] }, bandControl],
  caption: "Magnitude as observed, or -2.5 log of the intensity in m² sr⁻¹: the object alone, without range and eclipse. Filled: before the least phase angle of the pass; open: after it. Limits are left out.",
  build: (state) => {
    const value = (band, i) => !isMagnitude(band, i) ? null : state.scale === "mag" ? band.mag[i] : band.intensity[i] > 0 ? -2.5 * Math.log10(band.intensity[i]) : null;
    const data = [];
    chosenBands(state).forEach((b) => [0, 1].forEach((side) => {
      const line = { x: [], y: [], row: [] };
      shownPasses().forEach((pass) => {
        let last = null;
        for (const i of phaseBranches(pass)[side]) {
          if (last !== null && runOf[i] !== runOf[last]) { line.x.push(null); line.y.push(null); line.row.push(i); }
          line.x.push(epochs.phase[i]); line.y.push(value(bands[b], i)); line.row.push(i);
          last = i;
        }
        line.x.push(null); line.y.push(null); line.row.push(pass.rows[0]);
      });
      if (!line.y.some((one) => one !== null)) return;
      data.push({
        type: "scatter", mode: "lines+markers", ...line, text: line.row.map((i) => epochs.time[i]), name: plain(bands[b].label), legendgroup: bands[b].name,
        showlegend: !data.some((one) => one.legendgroup === bands[b].name), line: { color: bands[b].colour, width: 1.4, dash: bands[b].dash },
        marker: { color: bands[b].colour, symbol: bands[b].symbol + (side ? "-open" : ""), size: 6, maxdisplayed: 40 },
        hovertemplate: "%{y:.2f} mag at %{x:.2f}°<br>%{text}<extra>" + plain(bands[b].label) + "</extra>",
      });
    }));
    const ends = range(data.flatMap((trace) => trace.y));
    const faint = ends ? Math.min(ends[1], ends[0] + 12) : 1, pad = ends ? Math.max(0.1, 0.05 * (faint - ends[0])) : 0;
    return { data, layout: layout({ hovermode: "closest", xaxis: axis({ title: "phase angle [°]" }),
      yaxis: axis({ title: state.scale === "mag" ? report.mag_system + " magnitude" : "-2.5 log intensity", range: ends ? [faint + pad, ends[0] - pad] : [1, 0] }) }) };
  },
  table: () => tidyTable([["mag", "mag", (b, i) => b.mag[i]], ["intensity", "m2 sr-1", (b, i) => b.intensity[i]]]),
};

const planeFigure = {
  id: "qu_plane", title: "q-u plane", height: () => isNarrow() ? 430 : 460,
  controls: [bandControl],
  caption: "Sky frame, percent; colour is phase angle, marker shape is the band. Distance from the origin is p, half the angle around it the position angle.",
  build: (state) => {
    const theme = themeColours();
    const shown = chosenBands(state);
    const every = Math.max(1, Math.ceil(shownRows().length * shown.length / 900)); // more markers hide each other
    const data = shown.map((b) => {
      const line = joined((i) => percent(bands[b].q[i]), (i) => percent(bands[b].u[i]));
      return {
        type: "scatter", mode: "lines+markers", x: line.x, y: line.y, name: plain(bands[b].label), showlegend: false, text: line.row.map((i) => epochs.time[i]),
        line: { color: theme.line, width: 0.8 }, customdata: line.row.map((i) => epochs.phase[i]),
        marker: { color: line.row.map((i) => epochs.phase[i]), coloraxis: "coloraxis", symbol: bands[b].symbol, size: line.row.map((_, k) => k % every ? 0 : 7), line: { width: 0.5, color: theme.soft } },
        hovertemplate: "q %{x:.2f} %, u %{y:.2f} %<br>phase %{customdata:.2f}°<br>%{text}<extra>" + plain(bands[b].label) + "</extra>",
      };
    });
    // The legend explains the shapes; a marker coloured by phase has no colour of its own.
    chosenBands(state).forEach((b) => data.push({
      type: "scatter", mode: "markers", x: [null], y: [null], name: plain(bands[b].label), hoverinfo: "skip",
      marker: { symbol: bands[b].symbol, size: 9, color: theme.soft } }));
    return { data, layout: layout({
      hovermode: "closest", coloraxis: phaseAxis({ y: below(54, planeFigure.height(), 125) }), margin: { l: 50, r: 14, t: 8, b: 94 },
      xaxis: axis({ title: "q [%]", zeroline: true, zerolinecolor: theme.soft }),
      yaxis: axis({ title: "u [%]", scaleanchor: "x", zeroline: true, zerolinecolor: theme.soft }) }) };
  },
  table: () => tidyTable([["q", "", (b, i) => b.q[i]], ["u", "", (b, i) => b.u[i]]]),
};

function hasWebgl() {
  try {
    const canvas = document.createElement("canvas");
    const context = canvas.getContext("webgl2") || canvas.getContext("webgl");
    const works = !!context;
    const loser = works && context.getExtension("WEBGL_lose_context");
    if (loser) loser.loseContext();
    return works;
  } catch {
    return false;
  }
}

const rgbFigure = {
  id: "q_rgb", title: "Q in three bands", height: () => isNarrow() ? 380 : 460,
  caption: "q_scat of three bands in percent: drag to turn. Colour is phase angle"
    + (pureMaterials.length ? "; lines are surfaces of one material alone, over the phase angles of this curve." : "."),
  build: () => {
    if (!hasWebgl())
      throw new Error("This browser offers no WebGL, which the turning view needs (it may be switched off, or the graphics driver is blocked).");
    const theme = themeColours();
    const rows = shownRows().filter((i) => rgbBands.every((b) => bands[b].q_scat[i] !== null));
    const limits = range(rows.map((i) => epochs.phase[i])) || [0, 180];
    const data = [];
    pureMaterials.forEach((name, m) => {
      const parts = rgbBands.map((b) => report.pure_materials.find((c) => c.material === name && c.band === b));
      if (parts.some((part) => !part)) return;
      const own = report.contributions.find((part) => part.material === name);
      const at = parts[0].phase.map((phase, k) => ({ phase, q: parts.map((part) => percent(part.q_scat[k])) })).filter((e) => e.phase >= limits[0] - 1 && e.phase <= limits[1] + 1);
      data.push({ type: "scatter3d", mode: "lines", name, x: at.map((e) => e.q[0]), y: at.map((e) => e.q[1]), z: at.map((e) => e.q[2]),
        line: { color: own ? own.line_colour : theme.soft, width: 4, dash: m >= 7 ? "dash" : "solid" }, hovertemplate: "%{x:.1f}, %{y:.1f}, %{z:.1f} %" });
    });
    data.push({
      type: "scatter3d", mode: "markers", name: plain(report.object || "object"), showlegend: false, text: rows.map((i) => epochs.time[i]),
      x: rows.map((i) => percent(bands[rgbBands[0]].q_scat[i])), y: rows.map((i) => percent(bands[rgbBands[1]].q_scat[i])), z: rows.map((i) => percent(bands[rgbBands[2]].q_scat[i])),
      marker: { size: 3.5, color: rows.map((i) => epochs.phase[i]), coloraxis: "coloraxis" },
      hovertemplate: "%{x:.1f}, %{y:.1f}, %{z:.1f} %<br>%{text}",
    });
    const isSmall = isNarrow() || paper.isPrinting;
    const far = isNarrow() ? 1.1 : 0.95; // names of axes stand outside of the cube, most of them below it
    // The axes follow the object; material curves that go beyond are cut.
    const side = (b) => {
      const [low, high] = range(rows.map((i) => percent(bands[b].q_scat[i]))) || [0, 1];
      const pad = Math.max(0.5, 0.35 * (high - low));
      return axis({ title: { text: plain(bands[b].label) + " [%]", font: { size: isSmall ? 10 : 13 } }, tickfont: { size: isSmall ? 9 : 11 }, backgroundcolor: theme.card, range: [low - pad, high + pad], nticks: 5 });
    };
    return { data, layout: layout({
      coloraxis: phaseAxis({ y: -0.02 }), margin: { l: 0, r: 0, t: 8, b: 60 }, dragmode: "turntable",
      scene: { xaxis: side(rgbBands[0]), yaxis: side(rgbBands[1]), zaxis: side(rgbBands[2]), aspectmode: "cube", dragmode: "turntable", camera: { eye: { x: far * 2.1, y: -far * 1.25, z: far * 0.8 }, center: { x: 0, y: 0, z: -0.15 } } } }) };
  },
  table: () => ({
    columns: [{ name: "time_utc", unit: "" }, { name: "phase_angle", unit: "deg" }, ...rgbBands.map((b) => ({ name: "q_scat " + bands[b].name, unit: "" }))],
    rows: shownRows().map((i) => [epochs.time[i], epochs.phase[i], ...rgbBands.map((b) => bands[b].q_scat[i])]),
  }),
};

/// The sky track of a pass: whole passes if the run gave them, else the rows of the curve.
function trackOf(pass) {
  const track = report.sky_track;
  const rows = track.time.map((_, i) => i).filter((i) => track.pass[i] === pass.id);
  return rows.length ? { source: track, rows } : { source: epochs, rows: pass.rows };
}

/// Where letters of the whole sky stand, as seen from the zenith in pixels: the axis of altitude in the quarter that tracks leave most
/// free (`axisAngle`), and the times at their ends (`place`, one after the other): where the fewest points of tracks and
/// neither names of directions, altitudes nor other times are, outward before inward, or nowhere ("").
function skyLetters(isSmall) {
  const radius = isSmall ? 118 : 150, wide = isSmall ? 48 : 60, high = isSmall ? 12 : 15;
  const at = (azimuth, altitude) => {
    const r = (90 - altitude) / 90 * radius, turn = azimuth * Math.PI / 180;
    return [-r * Math.sin(turn), -r * Math.cos(turn)];
  };
  const around = ([x, y], w, h) => [x - w / 2, y - h / 2, x + w / 2, y + h / 2];
  const points = shownPasses().flatMap((pass) => {
    const { source, rows } = trackOf(pass);
    return rows.map((i) => at(source.az[i], source.alt[i]));
  });
  const meets = (a, b) => a[0] < b[2] && b[0] < a[2] && a[1] < b[3] && b[1] < a[3];
  const pointsIn = (box) => points.filter(([x, y]) => meets(box, [x - 4, y - 4, x + 4, y + 4])).length;
  // Angle from the right against the clock; numbers stand beside the axis, on its side with the clock.
  const marksAt = (angle) => [30, 60].map((altitude) => {
    const [x, y] = at(angle - 90, altitude), turn = (angle - 90) * Math.PI / 180;
    return around([x + 20 * Math.sign(Math.cos(turn)), y - 7 * Math.sign(Math.sin(turn))], 28, 14);
  });
  const covered = (angle) => marksAt(angle).reduce((sum, box) => sum + pointsIn(box), 0);
  const axisAngle = [45, 135, 225, 315].reduce((best, angle) => covered(angle) < covered(best) ? angle : best);
  const taken = marksAt(axisAngle);
  for (let k = 0; k < 8; ++k) taken.push(around(at(45 * k, -10), k % 2 ? 20 : 12, high)); // N, NE, ...
  const place = (azimuth, altitude) => {
    const [x, y] = at(azimuth, altitude), away = 9;
    const side = x < 0 ? "left" : "right", other = x < 0 ? "right" : "left", up = y < 0 ? "top" : "bottom", down = y < 0 ? "bottom" : "top";
    const places = [["middle", side], [up, side], [down, side], [up, other], ["middle", other], [down, other]];
    const boxes = places.map(([vertical, across]) => {
      const left = across === "left" ? x - away - wide : x + away, top = y + { top: -high - 3, middle: -high / 2, bottom: 3 }[vertical];
      return [left, top, left + wide, top + high];
    });
    const cost = boxes.map((box, k) => taken.some((one) => meets(box, one)) ? Infinity : k / 10 + pointsIn(box));
    const best = cost.indexOf(Math.min(...cost));
    if (cost[best] === Infinity) return "";
    taken.push(boxes[best]);
    return places[best].join(" ");
  };
  return { axisAngle, place };
}

/// The shown tracks as azimuths and altitudes, where all of them together are smaller than a dot would be on the
/// whole sky: a geostationary object, or a minute of a pass.
function closeUp() {
  const points = shownPasses().flatMap((pass) => {
    const { source, rows } = trackOf(pass);
    return rows.map((i) => ({ az: source.az[i], alt: source.alt[i] }));
  });
  if (!points.length) return null;
  const first = points[0].az;
  const az = range(points.map((at) => first + ((at.az - first + 540) % 360) - 180)), alt = range(points.map((at) => at.alt));
  const wide = (az[1] - az[0]) * Math.cos(alt[0] * Math.PI / 180);
  return Math.max(wide, alt[1] - alt[0]) < 5 ? { az, alt, first, reach: Math.max(wide, alt[1] - alt[0], 0.02) } : null;
}

/// Azimuth against altitude, as one looks at it, to one scale.
function closeUpPlot(near, isAngle, colours) {
  const theme = themeColours();
  const stretch = 1 / Math.max(0.05, Math.cos(near.alt[0] * Math.PI / 180));
  const azimuth = (value) => near.first + ((value - near.first + 540) % 360) - 180;
  const data = [];
  shownPasses().forEach((pass) => {
    const { source, rows } = trackOf(pass);
    data.push({ type: "scatter", mode: "lines", x: rows.map((i) => azimuth(source.az[i])), y: rows.map((i) => source.alt[i]),
      line: { color: theme.line, width: 5 }, hoverinfo: "skip", showlegend: false });
    data.push({ type: "scatter", mode: "markers", x: pass.rows.map((i) => azimuth(epochs.az[i])), y: pass.rows.map((i) => epochs.alt[i]),
      text: pass.rows.map((i) => epochs.time[i]), customdata: pass.rows.map((i) => epochs.phase[i]), showlegend: false,
      marker: { size: 6, color: pass.rows.map((i) => isAngle ? bands[middleBand].pa[i] : epochs.phase[i]), coloraxis: "coloraxis" },
      hovertemplate: "%{text}<br>azimuth %{x:.3f}°, altitude %{y:.3f}°<br>phase %{customdata:.1f}°<extra></extra>" });
    const last = rows.length - 1; // a time stands on the side to which the track does not go
    [[rows[0], rows[Math.min(1, last)], "circle-open"], [rows[last], rows[Math.max(0, last - 1)], "x-thin-open"]].forEach(([i, beside, symbol]) => data.push({
      type: "scatter", mode: "markers+text", x: [azimuth(source.az[i])], y: [source.alt[i]], text: [source.time[i].slice(11, 16)],
      textposition: source.alt[beside] > source.alt[i] ? "bottom center" : "top center",
      marker: { size: 8, symbol, color: theme.text, line: { width: 2 } }, hoverinfo: "skip", showlegend: false }));
  });
  const middle = (near.alt[0] + near.alt[1]) / 2, half = 0.7 * near.reach;
  return { data, layout: layout({ coloraxis: colours, hovermode: "closest", margin: { l: 60, r: 18, t: 8, b: 104 },
    xaxis: axis({ title: "azimuth [°]", range: [(near.az[0] + near.az[1]) / 2 - half * stretch, (near.az[0] + near.az[1]) / 2 + half * stretch], nticks: 5 }),
    yaxis: axis({ title: "altitude [°]", range: [middle - half, middle + half], scaleanchor: "x", scaleratio: stretch }) }) };
}

const skyFigure = {
  id: "sky", title: "Track in the sky", height: () => isNarrow() ? 440 : 460,
  controls: [{ key: "colour", name: "Colour", options: [["phase", "phase angle"], ["pa", "position angle"]] }],
  caption: "Looking up: north at the top, east at the left, the horizon outside; close up, as one faces it, where the object hardly moves. "
    + "Grey: in the Earth's shadow (also where no light is computed).",
  build: (state) => {
    const theme = themeColours();
    const data = [];
    const isAngle = state.colour === "pa" && bands.length > 0;
    const colours = isAngle
      ? { colorscale: cyclicScale(), cmin: 0, cmax: 180, colorbar: colourBar("position angle, " + bands[middleBand].label + " [°]", { tickvals: [0, 45, 90, 135, 180] }) }
      : phaseAxis();
    const near = closeUp();
    if (near) return closeUpPlot(near, isAngle, { ...colours, colorbar: { ...colours.colorbar, y: below(63, skyFigure.height(), 112) } });
    const shadow = { r: [], theta: [] };
    const letters = skyLetters(isNarrow());
    shownPasses().forEach((pass) => {
      const track = trackOf(pass);
      data.push({
        type: "scatterpolar", mode: "lines", r: track.rows.map((i) => 90 - track.source.alt[i]), theta: track.rows.map((i) => track.source.az[i]),
        line: { color: theme.line, width: 5 }, hoverinfo: "skip", showlegend: false,
      });
      for (const i of track.rows)
        if (track.source.sunlit[i] <= 0) {
          shadow.r.push(90 - track.source.alt[i]);
          shadow.theta.push(track.source.az[i]);
        }
      data.push({
        type: "scatterpolar", mode: "markers", r: pass.rows.map((i) => 90 - epochs.alt[i]), theta: pass.rows.map((i) => epochs.az[i]),
        text: pass.rows.map((i) => epochs.time[i]), customdata: pass.rows.map((i) => [epochs.alt[i], epochs.phase[i]]), showlegend: false,
        marker: { size: 6, color: pass.rows.map((i) => isAngle ? bands[middleBand].pa[i] : epochs.phase[i]), coloraxis: "coloraxis" },
        hovertemplate: "%{text}<br>azimuth %{theta:.1f}°, altitude %{customdata[0]:.1f}°<br>phase %{customdata[1]:.1f}°<extra></extra>",
      });
      const ends = [track.rows[0], track.rows[track.rows.length - 1]], places = ends.map((i) => letters.place(track.source.az[i], track.source.alt[i]));
      data.push({
        type: "scatterpolar", mode: "markers+text", r: ends.map((i) => 90 - track.source.alt[i]), theta: ends.map((i) => track.source.az[i]), cliponaxis: false,
        text: ends.map((i, k) => places[k] ? "\u00a0\u00a0\u00a0" + track.source.time[i].slice(11, 19) + "\u00a0\u00a0\u00a0" : ""), textposition: places.map((place) => place || "middle right"), textfont: { size: isNarrow() ? 9 : 11 },
        marker: { size: 8, symbol: ["circle-open", "x-thin-open"], color: theme.text, line: { width: 2 } }, hoverinfo: "skip", showlegend: false,
      });
    });
    if (shadow.r.length)
      data.push({ type: "scatterpolar", mode: "markers", ...shadow, name: "in the Earth's shadow", marker: { size: 6, symbol: "diamond", color: "#7f8794" }, hoverinfo: "skip", showlegend: true });
    return { data, layout: layout({
      coloraxis: colours, margin: isNarrow() ? { l: 46, r: 46, t: 26, b: 84 } : { l: 62, r: 62, t: 26, b: 84 }, dragmode: false,
      polar: {
        bgcolor: theme.card,
        radialaxis: { range: [0, 90], tickvals: [0, 30, 60, 90], ticktext: ["90°", "60°", "30°", ""], angle: letters.axisAngle, tickangle: letters.axisAngle, gridcolor: theme.grid, linecolor: theme.line, tickfont: { color: theme.soft } },
        angularaxis: { rotation: 90, direction: "counterclockwise", tickvals: [0, 45, 90, 135, 180, 225, 270, 315], ticktext: ["N", "NE", "E", "SE", "S", "SW", "W", "NW"], gridcolor: theme.grid, linecolor: theme.line },
      } }) };
  },
  table: () => ({
    columns: [["time_utc", ""], ["pass_id", ""], ["az", "deg"], ["alt", "deg"], ["sunlit", ""]].map(([name, unit]) => ({ name, unit })),
    rows: shownPasses().flatMap((pass) => {
      const { source, rows } = trackOf(pass);
      return rows.map((i) => [source.time[i], pass.id, source.az[i], source.alt[i], source.sunlit[i]]);
    }),
  }),
};
