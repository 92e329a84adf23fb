// Tracks over a site's sky, and the table beside them. All texts go in as text nodes.
(() => {
  "use strict";
  const page = JSON.parse(document.getElementById("data").textContent);
  const tracks = page.tracks;
  const drawnFull = 40; // tracks that are not mere hints
  const stands = 9; // a track that is no longer is a point
  const size = 1000, middle = size / 2, radius = 440;
  const space = "http://www.w3.org/2000/svg"; // the name of SVG, nothing is loaded from it
  const byId = (id) => document.getElementById(id);
  const svg = (tag, attributes, text) => {
    const node = document.createElementNS(space, tag);
    for (const [name, value] of Object.entries(attributes)) node.setAttribute(name, value);
    if (text !== undefined) node.textContent = text;
    return node;
  };
  const html = (tag, attributes, ...children) => {
    const node = document.createElement(tag);
    for (const [name, value] of Object.entries(attributes)) node.setAttribute(name, value);
    node.append(...children);
    return node;
  };

  // Colour: plasma without its palest end (Smith & van der Walt 2015, CC0), bright objects bright; on dark pages
  // without its darkest.
  const darkPage = window.matchMedia("(prefers-color-scheme: dark)");
  const lightScale = ["#0d0887", "#4c02a1", "#7e03a8", "#a92395", "#cc4778", "#e56b5d", "#f89540"];
  const darkScale = ["#5b6ee1", "#8058d6", "#a44cc4", "#cc4778", "#e56b5d", "#f89540", "#fdc527"];
  let scale = darkPage.matches ? darkScale : lightScale;
  const magnitudes = tracks.map((track) => track.mag).filter((mag) => mag !== null);
  const brightest = Math.min(...magnitudes), faintest = Math.min(Math.max(...magnitudes), brightest + 12);
  const hasMagnitudes = magnitudes.length > 0;
  const mixed = (share) => {
    const at = Math.max(0, Math.min(1, share)) * (scale.length - 1), k = Math.min(scale.length - 2, Math.floor(at));
    const part = (hex, i) => parseInt(hex.slice(1 + 2 * i, 3 + 2 * i), 16);
    return "rgb(" + [0, 1, 2].map((i) => Math.round(part(scale[k], i) * (k + 1 - at) + part(scale[k + 1], i) * (at - k))).join(",") + ")";
  };
  const shareOf = (mag) => faintest > brightest ? (faintest - mag) / (faintest - brightest) : 1;
  const colourOf = (track) => track.mag !== null ? mixed(shareOf(track.mag)) : hasMagnitudes ? "#8a93a2" : track.visible > 0 ? "#cc4778" : "#7e8aa0";
  const seen = (track) => track.alt_visible ?? track.alt - 90; // what is never visible stands below all that is
  // The best first: bright, and without magnitudes high.
  const order = tracks.map((_, i) => i).sort((a, b) => {
    const x = tracks[a], y = tracks[b];
    if (hasMagnitudes) return (x.mag ?? 99) - (y.mag ?? 99) || seen(y) - seen(x);
    return seen(y) - seen(x);
  });

  const best = new Set(order.slice(0, drawnFull));
  const isOneDay = new Set(tracks.map((track) => track.culmination.slice(0, 10))).size < 2;

  const places = tracks.map((track) => track.alt100.map((altitude, k) => {
    const r = (90 - altitude / 100) / 90 * radius, a = track.az100[k] / 100 * Math.PI / 180;
    return [middle - r * Math.sin(a), middle - r * Math.cos(a)];
  }));
  /// The sunlit or the dark parts of a track.
  const pathOf = (i, isLit) => {
    const track = tracks[i];
    let out = "", open = false;
    for (let k = 0; k < track.az100.length; ++k) {
      const [x, y] = places[i][k], is = track.sunlit[k] === isLit;
      const touches = is || (k > 0 && track.sunlit[k - 1] === isLit); // a part ends where the other begins
      if (touches) out += (open ? "L" : "M") + x.toFixed(1) + " " + y.toFixed(1);
      open = is;
    }
    return out;
  };

  const chart = byId("sky");
  const layers = {};
  const clock = (iso) => iso ? iso.slice(11, 19) : "";

  const drawGround = () => {
    const ground = svg("g", { fill: "none", stroke: "var(--grid)", "stroke-width": 1.5 });
    for (const altitude of [0, 30, 60]) ground.append(svg("circle", { cx: middle, cy: middle, r: (90 - altitude) / 90 * radius, stroke: altitude ? "var(--grid)" : "var(--soft)" }));
    for (let azimuth = 0; azimuth < 360; azimuth += 45) {
      const a = azimuth * Math.PI / 180;
      ground.append(svg("path", { d: "M" + middle + " " + middle + "L" + (middle - radius * Math.sin(a)).toFixed(1) + " " + (middle - radius * Math.cos(a)).toFixed(1) }));
    }
    const texts = svg("g", { fill: "var(--soft)", "font-size": fontSize(), "text-anchor": "middle" });
    layers.compass = [];
    ["N", "NE", "E", "SE", "S", "SW", "W", "NW"].forEach((name, k) => {
      const a = k * Math.PI / 4, r = radius + 12 + fontSize() * 0.6, x = middle - r * Math.sin(a), y = middle - r * Math.cos(a);
      layers.compass.push([x - fontSize(), y - 0.7 * fontSize(), x + fontSize(), y + 0.7 * fontSize()]);
      texts.append(svg("text", { x: (middle - r * Math.sin(a)).toFixed(1), y: (middle - r * Math.cos(a) + fontSize() * 0.35).toFixed(1), ...(name.length === 1 ? { "font-weight": 600 } : {}) }, name));
    });
    for (const altitude of [30, 60]) texts.append(svg("text", { x: middle + 4, y: middle - (90 - altitude) / 90 * radius - 4, "text-anchor": "start", "font-size": 0.8 * fontSize() }, altitude + "°"));
    chart.append(ground, texts);
  };
  const isSmall = () => (chart.clientWidth || 800) < 480;
  /// Letters keep their size on the screen.
  const fontSize = () => 13 * size / Math.max(300, chart.clientWidth || 800);

  const drawTrack = (i) => {
    const track = tracks[i], isHint = !best.has(i);
    const group = svg("g", { "data-track": i, "data-hint": Number(isHint), fill: "none", stroke: colourOf(track), "stroke-linecap": "round" });
    const lit = pathOf(i, 1), dark = pathOf(i, 0);
    if (dark) group.append(svg("path", { d: dark, "stroke-width": isHint ? 1.5 : 2, "stroke-dasharray": "2 6", opacity: 0.7 }));
    if (lit) group.append(svg("path", { d: lit, "stroke-width": isHint ? 2 : 3.5 }));
    // An arrow head at the end tells the way; what hardly moves has none, and a ring about it to be seen by.
    const last = track.az100.length - 1, centre = places[i][Math.floor(last / 2)];
    if (places[i].every(([x, y]) => Math.hypot(x - centre[0], y - centre[1]) < stands)) {
      group.append(svg("circle", { cx: centre[0].toFixed(1), cy: centre[1].toFixed(1), r: stands, "stroke-width": isHint ? 2 : 3.5 }));
    } else if (last > 0 && !isHint) {
      const [x, y] = places[i][last], [px, py] = places[i][last - 1], length = Math.hypot(x - px, y - py) || 1;
      const ux = (x - px) / length, uy = (y - py) / length;
      const at = (along, side) => (x + along * ux - side * uy).toFixed(1) + " " + (y + along * uy + side * ux).toFixed(1);
      group.append(svg("path", { d: "M" + at(-11, 6) + "L" + at(0, 0) + "L" + at(-11, -6), "stroke-width": 2.5 }));
    }
    group.append(svg("path", { d: lit + dark, "stroke-width": 18, stroke: "transparent", "pointer-events": "stroke" })); // easy to hit
    group.addEventListener("pointerenter", () => point(i, false));
    group.addEventListener("pointerleave", () => point(null, false));
    group.addEventListener("click", () => pick(i));
    return group;
  };

  // With a magnitude, the time at which it has it; where little room is, one of the two.
  const textOf = (track, isFull) => [track.name, track.mag !== null ? track.mag.toFixed(1) + " mag" : "", isFull || track.mag === null ? clock(track.brightest || track.culmination) : ""].filter(Boolean).join(", ");
  /// Points of a track that a label may stand at: the lit ones, where there are any.
  const labelled = tracks.map((track) => {
    const all = track.az100.map((_, k) => k), lit = all.filter((k) => track.sunlit[k] === 1);
    return lit.length ? lit : all;
  });
  /// Whether a track other than `i` runs under a box.
  const isCrossed = (box, i) => order.slice(0, drawnFull).some((j) => j !== i && places[j].some(([x, y]) => x > box[0] - 4 && x < box[2] + 4 && y > box[1] - 4 && y < box[3] + 4));
  /// A label beside a track where nothing else is, at the most the track itself, or in a sky full of tracks any of
  /// them, or null.
  const labelFor = (i, taken, isForced) => {
    const track = tracks[i], text = textOf(track, isForced || !isSmall()), font = fontSize();
    const width = 0.56 * font * text.length + 8, height = 1.3 * font;
    const isAlone = (box, own) => own === "any" || !isCrossed(box, own);
    for (const [share, own] of [undefined, i, "any"].flatMap((one) => [0.5, 0.35, 0.65, 0.2, 0.8, 0.08, 0.92].map((at) => [at, one])))
      for (const [across, down] of [[1, 0], [-1, 0], [0, -1], [0, 1]]) { // beside it, above, below
        const [x, y] = places[i][labelled[i][Math.round(share * (labelled[i].length - 1))]];
        const left = x - width / 2 + across * (width / 2 + 8), top = y - height / 2 + down * (height / 2 + 8);
        const box = [left, top, left + width, top + height];
        const isInside = box[0] > 2 && box[1] > 2 && box[2] < size - 2 && box[3] < size - 2;
        const isFree = taken.every((other) => box[2] < other[0] || box[0] > other[2] || box[3] < other[1] || box[1] > other[3]);
        if (!isInside || !(isForced || (isFree && isAlone(box, own)))) continue;
        taken.push(box);
        const group = svg("g", { "pointer-events": "none" });
        group.append(svg("rect", { x: left, y: top, width, height, rx: 4, fill: "var(--card)", opacity: 0.86 }),
          svg("text", { x: left + 4, y: top + 0.95 * font, "font-size": font, fill: "var(--text)" }, text));
        return group;
      }
    return null;
  };

  const drawScale = () => {
    if (!hasMagnitudes || brightest === faintest) return;
    const font = fontSize(), width = Math.max(210, 9 * font), x = size - width - 16, y = size - 1.9 * font;
    const group = svg("g", { "font-size": font, fill: "var(--soft)" });
    for (let k = 0; k < 42; ++k) group.append(svg("rect", { x: x + k * width / 42, y, width: width / 42 + 0.6, height: 0.6 * font, fill: mixed(k / 41) }));
    group.append(svg("text", { x, y: y + 1.7 * font }, (magnitudes.some((m) => m > faintest) ? "> " : "") + faintest.toFixed(1)),
      svg("text", { x: x + width, y: y + 1.7 * font, "text-anchor": "end" }, brightest.toFixed(1) + " mag"));
    chart.append(group);
  };

  let picked = null, near = null;
  const drawLabels = () => {
    layers.labels.replaceChildren();
    const taken = [...layers.compass], wanted = [...new Set([near, picked].filter((i) => i !== null))];
    for (const i of wanted) layers.labels.append(labelFor(i, taken, true) || "");
    if (near === null)
      for (const i of order.slice(0, isSmall() ? 3 : 8)) if (i !== picked) layers.labels.append(labelFor(i, taken, false) || "");
  };
  /// A track comes to the front, the others step back; its row is seen.
  const point = (i, fromTable) => {
    near = i;
    for (const group of layers.tracks.children) {
      const k = Number(group.dataset.track), isOn = k === near || k === picked;
      group.setAttribute("opacity", isOn ? 1 : (near === null && picked === null ? 1 : 0.3) * (group.dataset.hint === "1" ? 0.35 : 1));
    }
    for (const row of document.querySelectorAll("tbody tr")) {
      const isOn = Number(row.dataset.track) === i || Number(row.dataset.track) === picked;
      row.classList.toggle("near", isOn);
      const list = byId("list");
      if (Number(row.dataset.track) === i && !fromTable && list.scrollHeight > list.clientHeight) row.scrollIntoView({ block: "nearest" });
    }
    drawLabels();
  };
  const pick = (i) => {
    picked = picked === i ? null : i;
    point(i, false);
  };

  const drawChart = () => {
    chart.setAttribute("viewBox", "0 0 " + size + " " + size);
    chart.replaceChildren();
    drawGround();
    layers.tracks = svg("g", {});
    for (const i of [...order].reverse()) layers.tracks.append(drawTrack(i));
    layers.labels = svg("g", {});
    chart.append(layers.tracks, layers.labels);
    drawScale();
    point(near, true);
  };

  const two = (n) => String(n).padStart(2, "0");
  const duration = (seconds) => {
    const s = Math.round(seconds), min = Math.round(s / 60);
    return s < 60 ? s + " s" : s < 3600 ? Math.floor(s / 60) + " min " + two(s % 60) + " s" : Math.floor(min / 60) + " h " + two(min % 60) + " min";
  };
  const columns = [
    { name: "object", text: (t) => t.name, key: (t) => t.name },
    { name: "highest [UTC]", text: (t) => isOneDay ? clock(t.culmination) : t.culmination.slice(5, 19).replace("T", " "), key: (t) => t.culmination },
    ...(hasMagnitudes ? [{ name: "brightest", wide: true, text: (t) => clock(t.brightest), key: (t) => t.brightest || "9" }] : []),
    { name: "alt [°]", number: true, text: (t) => t.alt_visible === null ? "(" + t.alt.toFixed(0) + ")" : t.alt_visible.toFixed(0), key: (t) => -seen(t) },
    ...(hasMagnitudes ? [{ name: "mag", number: true, text: (t) => t.mag === null ? "" : t.mag.toFixed(1), key: (t) => t.mag ?? 99 }] : []),
    { name: "phase [°]", number: true, middle: true, text: (t) => t.phase[0] === null ? "" : t.phase[0].toFixed(0) + "–" + t.phase[1].toFixed(0), key: (t) => t.phase[0] ?? 999 },
    { name: "visible", number: true, middle: true, text: (t) => t.visible > 0 ? duration(t.visible) : "", key: (t) => -t.visible },
    { name: "rise", wide: true, text: (t) => clock(t.rise) || "before", key: (t) => t.rise },
    { name: "set", wide: true, text: (t) => clock(t.set) || "after", key: (t) => t.set || "9" },
  ];
  const sorting = { column: columns.find((column) => page.order && column.name.split(" ")[0] === page.order) || columns[1], isReversed: false };
  let isOnPaper = false;
  const fillTable = () => {
    const rows = tracks.map((_, i) => i).sort((a, b) => {
      const x = sorting.column.key(tracks[a]), y = sorting.column.key(tracks[b]);
      return (x < y ? -1 : x > y ? 1 : a - b) * (sorting.isReversed ? -1 : 1);
    });
    const kind = (column) => [column.number ? "number" : "", column.wide ? "wide" : "", column.middle ? "middle" : ""].filter(Boolean).join(" ").trim();
    const head = columns.map((column) => {
      const isSorted = column === sorting.column;
      // A button in a head that comes again on each sheet is left blank there.
      const button = html(isOnPaper ? "span" : "button", isOnPaper ? {} : { type: "button", class: kind(column) }, column.name + (isSorted ? (sorting.isReversed ? " ▾" : " ▴") : ""));
      button.addEventListener("click", () => {
        sorting.isReversed = isSorted && !sorting.isReversed;
        sorting.column = column;
        fillTable();
      });
      return html("th", { scope: "col", class: kind(column), "aria-sort": isSorted ? (sorting.isReversed ? "descending" : "ascending") : "none" }, button);
    });
    const body = rows.map((i) => {
      const cells = columns.map((column, k) => html("td", { class: kind(column) },
        ...(k === 0 ? [html("span", { class: "swatch", style: "background:" + colourOf(tracks[i]) })] : []), column.text(tracks[i])));
      const row = html("tr", { "data-track": i, tabindex: 0 }, ...cells);
      row.addEventListener("pointerenter", () => point(i, true));
      row.addEventListener("pointerleave", () => point(null, true));
      row.addEventListener("click", () => pick(i));
      row.addEventListener("keydown", (event) => { if (event.key === "Enter") pick(i); });
      return row;
    });
    byId("list").replaceChildren(html("table", {}, html("thead", {}, html("tr", {}, ...head)), html("tbody", {}, ...body)));
    point(near, true);
  };

  document.title = "umov: " + page.title;
  byId("title").textContent = page.title;
  byId("subtitle").textContent = (isOneDay && tracks.length ? tracks[0].culmination.slice(0, 10) + ": " : "") + tracks.length + (tracks.length === 1 ? " pass" : " passes") + (page.model ? "; magnitudes: " + page.model.replace(/\bnm:([0-9.]+)/, "$1 nm") : "");
  for (const note of page.notes) byId("notes").append(html("li", {}, note));
  drawChart();
  fillTable();
  let width = chart.clientWidth;
  new ResizeObserver(() => {
    if (Math.abs(chart.clientWidth - width) < 2) return;
    width = chart.clientWidth;
    drawChart();
  }).observe(chart);
  const redraw = () => {
    drawChart();
    fillTable();
  };
  darkPage.addEventListener("change", () => {
    scale = darkPage.matches ? darkScale : lightScale;
    redraw();
  });
  window.addEventListener("beforeprint", () => {
    near = picked = null;
    scale = lightScale;
    isOnPaper = true;
    redraw();
  });
  window.addEventListener("afterprint", () => {
    scale = darkPage.matches ? darkScale : lightScale;
    isOnPaper = false;
    redraw();
  });
})();
