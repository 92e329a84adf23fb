// The data of the page: passes, runs without gaps, tables for saving.

const report = JSON.parse(document.getElementById("umov-data").textContent);
const epochs = report.epochs;
const bands = report.bands;
const epochCount = epochs.time.length;

/// Plotly takes some HTML (links, line breaks) in names and texts: those of files stand as they are.
const plain = (name) => name.replaceAll("&", "&amp;").replaceAll("<", "&lt;");

// Okabe & Ito (2008); the first three follow the wavelength from blue to red.
const threeBandColours = ["#0072b2", "#009e73", "#d55e00"];
const manyBandColours = ["#0072b2", "#56b4e9", "#009e73", "#e69f00", "#d55e00", "#cc79a7", "#7f8794"];
const symbols = ["circle", "square", "triangle-up", "diamond", "cross", "x", "star"];
const symbols3d = ["circle", "square", "diamond", "cross", "x", "circle-open", "square-open"];

const byWavelength = bands.map((_, i) => i).sort((a, b) => bands[a].wavelength_nm - bands[b].wavelength_nm);
bands.forEach((band, i) => {
  band.label = /^nm:[0-9.]+$/.test(band.name) ? band.name.slice(3) + " nm" : band.name; // tables keep the name
  const rank = byWavelength.indexOf(i);
  const palette = bands.length <= 3 ? threeBandColours : manyBandColours;
  band.colour = bands.length === 1 ? palette[0] : palette[rank % palette.length];
  band.symbol = symbols[rank % symbols.length];
  band.dash = ["solid", "dash", "dot"][Math.floor(rank / palette.length) % 3]; // where colours come again
});
const middleBand = byWavelength.length ? byWavelength[Math.floor(byWavelength.length / 2)] : 0;
/// Short, middle and long wavelength; empty with fewer than three bands.
const rgbBands = bands.length < 3 ? []
  : [byWavelength[0], middleBand, byWavelength[byWavelength.length - 1]];

/// Plotly wants dates without zone; 23:59:60 is drawn just before midnight.
const plotTime = (iso) => iso.replace("T", " ").replace("Z", "").replace(/:60(\.\d*)?$/, ":59.999");
const milliseconds = (iso) => Date.parse(plotTime(iso).replace(" ", "T") + "Z");
const times = epochs.time.map(plotTime);
const clock = epochs.time.map(milliseconds);

/// Rows of one passage, and the runs in them that a line may join.
function makePass(id, rows) {
  const steps = rows.slice(1).map((row, k) => clock[row] - clock[rows[k]]).sort((a, b) => a - b);
  const step = steps.length ? steps[Math.floor(steps.length / 2)] : 0;
  const runs = [];
  rows.forEach((row, k) => {
    if (k === 0 || clock[row] - clock[rows[k - 1]] > 1.5 * step) runs.push([]);
    runs[runs.length - 1].push(row);
  });
  const start = epochs.time[rows[0]];
  return { id, rows, runs, label: start.slice(0, 10) + " " + start.slice(11, 16), day: start.slice(0, 10) };
}

const passes = (() => {
  const out = [];
  let rows = [];
  for (let i = 0; i < epochCount; ++i) {
    rows.push(i);
    if (i + 1 === epochCount || epochs.pass[i + 1] !== epochs.pass[i]) {
      out.push(makePass(epochs.pass[i], rows));
      rows = [];
    }
  }
  return out;
})();

/// For each row a number that its run shares.
const runOf = [];
passes.flatMap((pass) => pass.runs).forEach((run, k) => run.forEach((row) => { runOf[row] = k; }));

/// Which passes are shown: "all" or the number of one.
const selection = { pass: passes.length === 1 ? "0" : "all" };
const shownPasses = () => selection.pass === "all" ? passes : [passes[Number(selection.pass)]].filter(Boolean);
const shownRows = () => shownPasses().flatMap((pass) => pass.rows);

/// Points of a pass with an empty one between runs, so that no line crosses a gap.
function gapped(pass, valueAt) {
  const out = { x: [], y: [], row: [] };
  pass.runs.forEach((run, k) => {
    if (k > 0) {
      out.x.push(times[run[0]]);
      out.y.push(null);
      out.row.push(run[0]);
    }
    for (const row of run) {
      out.x.push(times[row]);
      out.y.push(valueAt(row));
      out.row.push(row);
    }
  });
  return out;
}

/// The same for an angle in [0, 180): also broken where it goes round.
function gappedCyclic(pass, valueAt) {
  const line = gapped(pass, valueAt);
  const out = { x: [], y: [], row: [] };
  line.y.forEach((value, k) => {
    const last = k > 0 ? line.y[k - 1] : null;
    if (value !== null && last !== null && Math.abs(value - last) > 90) {
      out.x.push(line.x[k]);
      out.y.push(null);
      out.row.push(line.row[k]);
    }
    out.x.push(line.x[k]);
    out.y.push(value);
    out.row.push(line.row[k]);
  });
  return out;
}

const percent = (value) => value === null ? null : 100 * value;
const positive = (value) => value > 0 ? value : null;
const fixed = (value, digits) => value === null || !Number.isFinite(value) ? "" : value.toFixed(digits);

/// One band leaves nothing to choose: a control of one option is not shown.
const bandControl = { key: "band", name: "Band", options: [["all", "all"], ...byWavelength.map((b) => [b, bands[b].label])].slice(bands.length === 1 ? 1 : 0) };
const chosenBands = (state) => byWavelength.filter((b) => state.band === undefined || state.band === "all" || state.band === b);

/// A colour of six digits, seen through.
const faint = (hex, opacity) => "rgba(" + [1, 3, 5].map((k) => parseInt(hex.slice(k, k + 2), 16)).join(",") + "," + opacity + ")";

/// Least and greatest finite value, or null.
function range(values) {
  let low = Infinity, high = -Infinity;
  for (const value of values)
    if (value !== null && Number.isFinite(value)) {
      low = Math.min(low, value);
      high = Math.max(high, value);
    }
  return low <= high ? [low, high] : null;
}

/// A table {columns: [{name, unit}], rows} as CSV with the units in a comment above the header.
function csvText(table) {
  const field = (value) => {
    if (value === null || value === undefined || Number.isNaN(value)) return "";
    const text = typeof value === "number" ? String(Number(value.toPrecision(9))) : String(value);
    return /[",\n\r]/.test(text) ? '"' + text.replace(/"/g, '""') + '"' : text;
  };
  return ["# unit: " + table.columns.map((c) => c.unit || "''").join(","),
    table.columns.map((c) => field(c.name)).join(","),
    ...table.rows.map((row) => row.map(field).join(","))].join("\n") + "\n";
}

/// One row per epoch and band: `values` are [name, unit, (band, row) => value].
function tidyTable(values) {
  const rows = [];
  for (const row of shownRows())
    for (const band of bands)
      rows.push([epochs.time[row], epochs.pass[row], band.name, epochs.phase[row],
        ...values.map(([, , at]) => at(band, row))]);
  const columns = [["time_utc", ""], ["pass_id", ""], ["band", ""], ["phase_angle", "deg"], ...values];
  return { columns: columns.map(([name, unit]) => ({ name, unit })), rows };
}
