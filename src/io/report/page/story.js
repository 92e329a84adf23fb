// Tells the story of the data block. All texts go in as text nodes.
(() => {
  "use strict";
  const page = JSON.parse(document.getElementById("data").textContent);
  const make = (name, text, className) => {
    const out = document.createElement(name);
    if (text !== undefined) out.textContent = text;
    if (className) out.className = className;
    return out;
  };
  const badges = { agrees: "agrees", partly: "in part", differs: "differs", shown: "shown" };
  const badge = (verdict) => make("span", badges[verdict] ?? verdict, "badge " + verdict);
  const table = (data, className) => {
    const out = make("table", undefined, className);
    if (data.caption) out.append(make("caption", data.caption));
    const head = make("tr");
    head.append(...data.head.map((text) => make("th", text)));
    const top = make("thead");
    top.append(head);
    const body = make("tbody");
    for (const row of data.rows) {
      const line = make("tr");
      line.append(...row.map((cell) => {
        const td = make("td");
        td.append(cell);
        return td;
      }));
      body.append(line);
    }
    out.append(top, body);
    const scroll = make("div", undefined, "scroll");
    scroll.append(out);
    return scroll;
  };
  const paragraph = (label, text) => {
    const out = make("p", undefined, "lead");
    out.append(make("b", label + " "), text);
    return out;
  };
  document.title = page.title;
  document.getElementById("title").textContent = page.title;
  document.getElementById("introduction").append(...page.introduction.map((text) => make("p", text)));
  const story = document.getElementById("story");
  const rows = [];
  for (const chapter of page.chapters)
    for (const section of chapter.sections) {
      const link = make("a", section.title);
      link.href = "#" + section.id;
      rows.push([link, badge(section.verdict), section.summary]);
    }
  const overview = make("section");
  overview.append(make("h3", "Overview"), table({ head: ["", "the paper", "in one line"], rows }, "overview"));
  story.append(overview);
  const later = [];
  for (const chapter of page.chapters) {
    story.append(make("h2", chapter.heading, "chapter"));
    for (const section of chapter.sections) {
      const card = make("section");
      card.id = section.id;
      const heading = make("h3", section.title);
      heading.append(badge(section.verdict));
      card.append(heading);
      if (section.claim) card.append(paragraph("The paper:", section.claim));
      card.append(...section.found.map((text) => make("p", text)));
      const pictures = make("div", undefined, "pictures");
      for (const picture of section.pictures) {
        const figure = make("figure"), image = make("img");
        image.src = picture.src;
        image.alt = picture.caption;
        figure.append(image, make("figcaption", picture.caption));
        pictures.append(figure);
      }
      const plots = make("div", undefined, "plots");
      for (const plot of section.plots) {
        const figure = make("figure"), place = make("div", undefined, "plot");
        figure.append(make("h4", plot.title), place);
        plots.append(figure);
        later.push([place, plot]);
      }
      if (section.pictures.length) card.append(pictures);
      if (section.plots.length) card.append(plots);
      for (const data of section.tables) card.append(table(data));
      if (section.files.length) {
        const files = make("p", "Files: ", "files");
        section.files.forEach((name, index) => {
          const link = make("a", name);
          link.href = name;
          files.append(index ? ", " : "", link);
        });
        card.append(files);
      }
      story.append(card);
    }
  }
  for (const note of page.notes) document.getElementById("notes").append(make("li", note));
  // Plots are drawn when they come near the window: a page of dozens opens at once.
  const drawn = new Set();
  const draw = (place, figure) => {
    if (drawn.has(place)) return;
    drawn.add(place);
    watch.unobserve(place);
    umovFigure(place, figure);
  };
  const watch = new IntersectionObserver((entries) => {
    for (const entry of entries)
      if (entry.isIntersecting) draw(entry.target, later.find(([place]) => place === entry.target)[1]);
  }, { rootMargin: "600px" });
  for (const [place] of later) watch.observe(place);
  // Paper has them all, and so has who waits: the others follow one by one when the page has nothing to do.
  window.addEventListener("beforeprint", () => later.forEach(([place, figure]) => draw(place, figure)));
  const whenIdle = window.requestIdleCallback || ((job) => setTimeout(job, 200));
  const drawNext = () => {
    const next = later.find(([place]) => !drawn.has(place));
    if (!next) return;
    draw(...next);
    whenIdle(drawNext);
  };
  whenIdle(drawNext);
  document.getElementById(location.hash.slice(1))?.scrollIntoView({ behavior: "instant" }); // it was not there yet
})();
