// Draws the figures of the data block. All texts go in as text nodes.
(() => {
  "use strict";
  const page = JSON.parse(document.getElementById("data").textContent);
  document.title = "umov: " + page.title;
  document.getElementById("title").textContent = page.title;
  for (const note of page.notes) {
    const item = document.createElement("li");
    item.textContent = note;
    document.getElementById("notes").append(item);
  }
  // All cards first: a plot takes the width that its card has once the grid is laid out.
  const plots = page.figures.map((figure) => {
    const card = document.createElement("section");
    card.className = "card";
    const heading = document.createElement("h2");
    heading.textContent = figure.title;
    const plot = document.createElement("div");
    plot.className = "plot";
    card.append(heading, plot);
    document.getElementById("figures").append(card);
    return plot;
  });
  page.figures.forEach((figure, index) => {
    const plot = plots[index];
    const lines = figure.lines.map((line) => ({
      type: "scatter", mode: "lines", name: line.name, x: line.x, y: line.y,
      line: { color: line.colour, dash: line.dash, width: 2 },
    }));
    const axis = (title, more) => Object.assign({
      title: { text: title }, gridcolor: "#e6e9ee", zerolinecolor: "#b8bfc9", automargin: true,
    }, more);
    Plotly.newPlot(plot, lines, {
      autosize: true,
      margin: { l: 60, r: 12, t: 10, b: 60 + 17 * Math.ceil(lines.length / 3) },
      xaxis: axis(figure.x, {}),
      yaxis: axis(figure.y, { type: figure.log ? "log" : "linear", exponentformat: "power" }),
      legend: { orientation: "h", yref: "container", y: 0, yanchor: "bottom", font: { size: 11 } },
      font: { family: "system-ui, sans-serif", size: 13 },
    }, { responsive: true, displaylogo: false,
         toImageButtonOptions: { format: "svg", filename: figure.title } });
    // The width of a card changes with scroll bars and columns, not with the window alone.
    let width = 0;
    new ResizeObserver(() => {
      if (plot.clientWidth === width || !plot.layout) return;
      width = plot.clientWidth;
      Plotly.Plots.resize(plot);
    }).observe(plot);
  });
})();
