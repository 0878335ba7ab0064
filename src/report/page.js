"use strict";
(() => {
  const byId = (id) => document.getElementById(id);

  // The viewer borrows the pictures of the contact sheets.
  const viewer = byId("viewer");
  const sheets = [...document.querySelectorAll(".shots")].map((sheet) => ({
    label: sheet.dataset.label,
    shots: [...sheet.querySelectorAll(".shot")].map((shot) => ({
      shot,
      name: shot.dataset.name,
      stats: shot.dataset.stats,
      image: shot.querySelector(".image"),
      flip: shot.querySelector(".flip"),
    })),
  }));
  if (viewer && sheets.length) {
    const [scene, left, right, zoom, flip, cut] = ["scene", "left", "right", "zoom", "flip", "cut"].map((n) => byId("v-" + n));
    const [a, b, stage, text] = ["a", "b", "stage", "text"].map((n) => byId("v-" + n));
    const fill = (select, names, chosen) => {
      select.replaceChildren(...names.map((name, i) => new Option(name, i, false, i === chosen)));
      select.selectedIndex = chosen;
    };
    const show = () => {
      const shots = sheets[scene.selectedIndex].shots;
      const [l, r] = [shots[left.selectedIndex], shots[right.selectedIndex]];
      const map = flip.checked && l.flip;
      a.src = (map ? l.flip : l.image).src;
      a.alt = (map ? l.flip : l.image).alt;
      b.src = r.image.src;
      b.alt = r.image.alt;
      const side = (where, shot, extra) => {
        const span = document.createElement("span");
        const name = document.createElement("b");
        name.textContent = shot.name;
        span.append(where + ": ", name, " " + shot.stats + extra);
        return span;
      };
      const none = flip.checked && !l.flip ? " (has no FLIP map)" : map ? " (FLIP map)" : "";
      text.replaceChildren(side("left", l, none), side("right", r, ""));
    };
    // The best network, or else the best method, against the exact image.
    const choose = () => {
      const names = sheets[scene.selectedIndex].shots.map((s) => s.name);
      const kept = names.indexOf(left.selectedOptions[0]?.textContent);
      const network = names.findIndex((n) => n.startsWith("neural:"));
      const truth = Math.max(names.indexOf("exact image"), 0);
      const first = network >= 0 ? network : names.length > 1 ? (truth === 0 ? 1 : 0) : 0;
      fill(left, names, kept >= 0 ? kept : first);
      fill(right, names, truth);
      show();
    };
    const move = () => stage.style.setProperty("--cut", cut.value + "%");
    let held = false;
    const drag = (event) => {
      if (event.type === "pointerdown" && event.button === 0) {
        held = true;
        // Keeps the divider in hand beyond the picture's edge.
        try { stage.setPointerCapture(event.pointerId); } catch { /* The pointer is gone already. */ }
      }
      if (!held) return;
      const box = stage.getBoundingClientRect();
      cut.value = (100 * (event.clientX - box.left)) / box.width;
      move();
    };
    const drop = () => { held = false; };
    fill(scene, sheets.map((s) => s.label), 0);
    choose();
    scene.addEventListener("change", choose);
    for (const control of [left, right, flip]) control.addEventListener("change", show);
    zoom.addEventListener("change", () => stage.style.setProperty("--zoom", zoom.value));
    cut.addEventListener("input", move);
    stage.addEventListener("pointerdown", drag);
    stage.addEventListener("pointermove", drag);
    stage.addEventListener("pointerup", drop);
    stage.addEventListener("pointercancel", drop);
    sheets.forEach((sheet, s) =>
      sheet.shots.forEach(({ shot }, i) =>
        shot.querySelector(".pick").addEventListener("click", () => {
          scene.selectedIndex = s;
          choose();
          left.selectedIndex = i;
          show();
          viewer.scrollIntoView({ block: "start" });
          cut.focus({ preventScroll: true });
        })
      )
    );
    viewer.hidden = false;
    move();
  }
  const flips = byId("g-flip");
  if (flips) {
    const toggle = () => flips.closest("section").classList.toggle("flips", flips.checked);
    flips.addEventListener("change", toggle);
    toggle();
  }

  // A click on a column's name sorts by it: numbers by size, what is no number last.
  for (const table of document.querySelectorAll("table.data")) {
    const heads = [...table.tHead.rows[0].cells];
    heads.forEach((head, column) => {
      const button = document.createElement("button");
      button.type = "button";
      button.append(...head.childNodes);
      head.append(button);
      button.addEventListener("click", () => {
        const down = head.getAttribute("aria-sort") === "ascending";
        heads.forEach((h) => h.removeAttribute("aria-sort"));
        head.setAttribute("aria-sort", down ? "descending" : "ascending");
        const numeric = [...table.tBodies[0].rows].some((r) => r.cells[column]?.dataset.v !== undefined);
        const key = (row) => {
          const cell = row.cells[column];
          return numeric ? Number(cell?.dataset.v ?? NaN) : (cell?.textContent ?? "");
        };
        const order = (x, y) => {
          if (!numeric) return (down ? -1 : 1) * x.localeCompare(y, "en");
          if (Number.isNaN(x) || Number.isNaN(y)) return Number.isNaN(x) - Number.isNaN(y);
          return down ? y - x : x - y;
        };
        const rows = [...table.tBodies[0].rows].map((row) => [key(row), row]);
        rows.sort((p, q) => order(p[0], q[0]));
        table.tBodies[0].append(...rows.map(([, row]) => row));
      });
    });
  }
})();
