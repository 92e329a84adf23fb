// Draws the figures of the data block. All texts go in as text nodes.
(() => {
  "use strict";
  const page = JSON.parse(document.getElementById("data").textContent);
  document.title = "umov: " + umovFigure.words(page.title);
  document.getElementById("title").textContent = umovFigure.words(page.title);
  if (page.lead) {
    const lead = document.getElementById("lead");
    lead.textContent = umovFigure.words(page.lead);
    lead.hidden = false;
  }
  for (const note of page.notes) {
    const item = document.createElement("li");
    item.textContent = umovFigure.words(note);
    document.getElementById("notes").append(item);
  }
  // All cards first: a plot takes the width that its card has once the grid is laid out.
  const plots = page.figures.map((figure) => {
    const card = document.createElement("section");
    card.className = "card";
    const heading = document.createElement("h2");
    heading.textContent = umovFigure.words(figure.title);
    const plot = document.createElement("div");
    plot.className = "plot";
    card.append(heading, plot);
    document.getElementById("figures").append(card);
    return plot;
  });
  page.figures.forEach((figure, index) => umovFigure(plots[index], figure));
})();
