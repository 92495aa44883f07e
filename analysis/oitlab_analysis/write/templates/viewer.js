
// Images: two methods of one setting, drawn on one canvas through the same zoom and pan.
const embedded = JSON.parse(document.getElementById("picture-data").textContent);
const loaded = new Map();  // address -> promise of a picture

// A picture: what to draw, its size in pixels of the file, and a canvas that holds its values. A file
// beside the page (linked, not embedded) can be drawn, but browsers do not let a page read it.
function load(entry) {
  const kept = embedded[entry.picture], address = kept ? kept.uri : entry.link;
  if (!address) return Promise.resolve(null);
  if (!loaded.has(address)) {
    loaded.set(address, new Promise(resolve => {
      const image = new Image();
      image.onerror = () => resolve(null);
      image.onload = () => {
        const copy = Object.assign(document.createElement("canvas"),
                                   { width: image.naturalWidth, height: image.naturalHeight });
        let values = null;
        if (kept) {
          const context = copy.getContext("2d", { willReadFrequently: true });
          context.drawImage(image, 0, 0);
          values = context.getImageData(0, 0, copy.width, copy.height);
        }
        resolve({ image, values, width: kept?.width ?? copy.width, height: kept?.height ?? copy.height,
                  scale: kept?.scale ?? 1 });
      };
      image.src = address;
    }));
  }
  return loaded.get(address);
}

// Where two pictures differ: the largest difference of a channel, times the gain, from black over red
// and yellow to white.
function errorMap(a, b, gain) {
  const { width, height } = a.values, map = new ImageData(width, height);
  const x = a.values.data, y = b.values.data;
  for (let i = 0; i < x.length; i += 4) {
    const error = Math.max(Math.abs(x[i] - y[i]), Math.abs(x[i + 1] - y[i + 1]),
                           Math.abs(x[i + 2] - y[i + 2])) * gain * 3;
    map.data[i] = error;
    map.data[i + 1] = error - 255;
    map.data[i + 2] = error - 510;
    map.data[i + 3] = 255;
  }
  const canvas = Object.assign(document.createElement("canvas"), { width, height });
  canvas.getContext("2d").putImageData(map, 0, 0);
  return canvas;
}

class Viewer {
  constructor(root) {
    this.root = root;
    this.section = sectionOf(root);
    this.settings = parsed(this.section, "settings");
    for (const name of ["setting", "a", "b", "mode", "slider", "reset", "value"])
      this[name] = root.querySelector("." + name);
    this.gainLabel = root.querySelector(".gain");
    this.gain = this.gainLabel.querySelector("select");
    this.canvas = root.querySelector("canvas");
    this.pictures = [null, null];
    this.setting.replaceChildren(...this.settings.map(({ heading }, i) => new Option(heading, i)));
    this.setting.addEventListener("change", () => { this.choose(); this.remember(); });
    for (const list of [this.a, this.b])
      list.addEventListener("change", () => { this.load(); this.remember(); });
    for (const control of [this.mode, this.gain]) control.addEventListener("change", () => this.draw());
    this.slider.addEventListener("input", () => { this.mode.value = "slider"; this.draw(); });
    this.reset.addEventListener("click", () => this.fit());
    this.canvas.addEventListener("wheel", event => {
      if (!root.contains(document.activeElement)) return;  // the wheel is the page's until a click
      event.preventDefault();
      this.zoomBy(Math.exp(-event.deltaY / 300), ...this.place(event));
    }, { passive: false });
    this.canvas.addEventListener("pointerdown", event => {
      root.focus({ preventScroll: true });
      this.canvas.setPointerCapture(event.pointerId);
      this.splitting = this.isOnSplit(this.place(event)[0]);
    });
    this.canvas.addEventListener("pointerup", () => { this.splitting = false; });
    this.canvas.addEventListener("pointermove", event => this.move(event));
    this.canvas.addEventListener("dblclick", () => this.fit());
    root.addEventListener("keydown", event => this.key(event));
    this.choose();
  }

  // The pictures of a setting: A the first that is not exact, B the first that is.
  choose(andLoad = true) {
    const pictures = this.settings[this.setting.value].pictures;
    for (const list of [this.a, this.b])
      list.replaceChildren(...pictures.map((picture, i) => new Option(picture.label, i)));
    const exact = Math.max(0, pictures.findIndex(picture => picture.exact));
    const other = pictures.findIndex((picture, i) => i !== exact && !picture.exact);
    this.b.value = exact;
    this.a.value = other >= 0 ? other : pictures.length > 1 && exact === 0 ? 1 : 0;
    if (andLoad) this.load();
  }

  // Picture `a`, and `b` if given, of a setting.
  show(setting, a, b) {
    if (Number(this.setting.value) !== setting) {
      this.setting.value = setting;
      this.choose(false);
    }
    this.a.value = a;
    if (b !== undefined) this.b.value = b;
    this.load();
    this.remember();
  }

  // The address of the page says what is shown: it can be sent to somebody.
  remember() {
    const { name, pictures } = this.settings[this.setting.value];
    const state = new URLSearchParams(allSections.length > 1 ? { section: this.section.dataset.section } : {});
    state.set("scene", name);
    for (const list of ["a", "b"]) state.set(list, pictures[this[list].value].label);
    history.replaceState(null, "", `#${state}`);
  }

  // Whether a place across the canvas is on the line between A and B.
  isOnSplit(x) {
    const line = this.canvas.width * this.slider.value / this.slider.max;
    return this.mode.value === "slider" && Math.abs(x - line) < 12;
  }

  async load() {
    const pictures = this.settings[this.setting.value].pictures;
    const entries = [this.a, this.b].map(list => pictures[list.value]);
    ["a", "b"].forEach((name, i) => {
      const { label, error, parameters, link, problem } = entries[i];
      const caption = this.root.querySelector(".caption-" + name);
      caption.textContent = `${name.toUpperCase()}: ${label}: ${problem || error}` +
                            (parameters ? ` (${parameters}) ` : " ");
      if (link) caption.append(Object.assign(document.createElement("a"),
                                             { href: link, textContent: "file" }));
    });
    const wanted = this.wanted = {};
    const found = await Promise.all(entries.map(load));
    if (this.wanted !== wanted) return;  // another choice was made meanwhile
    this.pictures = found;
    this.map = null;
    const size = found.find(Boolean);
    this.size = size ? [size.width, size.height] : [16, 9];
    this.canvas.height = Math.round(this.canvas.width * this.size[1] / this.size[0]);
    this.fit();
  }

  fit() {
    this.zoom = this.canvas.width / this.size[0];  // canvas pixels for one of the image
    this.left = this.top = 0;                      // the image point in the corner
    this.draw();
  }

  zoomBy(factor, x, y) {
    const zoom = Math.min(64, Math.max(this.canvas.width / this.size[0], this.zoom * factor));
    this.left += x / this.zoom - x / zoom;
    this.top += y / this.zoom - y / zoom;
    this.zoom = zoom;
    this.draw();
  }

  // Canvas pixels under the pointer.
  place(event) {
    const box = this.canvas.getBoundingClientRect();
    return [(event.clientX - box.left) * this.canvas.width / box.width,
            (event.clientY - box.top) * this.canvas.height / box.height];
  }

  move(event) {
    const [x, y] = this.place(event);
    this.canvas.style.cursor = this.splitting || this.isOnSplit(x) ? "ew-resize" : "crosshair";
    if (this.splitting) {
      this.slider.value = Math.round(x / this.canvas.width * this.slider.max);
      this.draw();
    } else if (event.buttons & 1 && this.last) {
      this.left -= (x - this.last[0]) / this.zoom;
      this.top -= (y - this.last[1]) / this.zoom;
      this.draw();
    }
    this.last = [x, y];
    this.showValue(Math.floor(this.left + x / this.zoom), Math.floor(this.top + y / this.zoom));
  }

  showValue(x, y) {
    if (x < 0 || y < 0 || x >= this.size[0] || y >= this.size[1]) return;
    const texts = this.pictures.map((picture, i) => {
      const name = "AB"[i];
      if (!picture) return `${name} none`;
      if (!picture.values) return `${name} not in the page`;
      const column = Math.min(picture.values.width - 1, Math.floor(x / picture.scale));
      const row = Math.min(picture.values.height - 1, Math.floor(y / picture.scale));
      const at = 4 * (row * picture.values.width + column);
      return `${name} ${[...picture.values.data.slice(at, at + 3)].join(" ")}` +
             (picture.scale > 1 ? " (mean)" : "");
    });
    this.value.textContent = `x ${x}  y ${y}   ${texts.join("   ")}`;
  }

  key(event) {
    if (event.target.matches("select, input") && event.key !== "f") return;
    const middle = [this.canvas.width / 2, this.canvas.height / 2], step = 40 / this.zoom;
    const actions = {
      f: () => { this.mode.value = this.mode.value === "a" ? "b" : "a"; },
      e: () => { this.mode.value = this.mode.value === "error" ? "slider" : "error"; },
      "+": () => this.zoomBy(1.5, ...middle), "-": () => this.zoomBy(1 / 1.5, ...middle),
      "0": () => this.fit(),
      ArrowLeft: () => { this.left -= step; }, ArrowRight: () => { this.left += step; },
      ArrowUp: () => { this.top -= step; }, ArrowDown: () => { this.top += step; },
    };
    const action = event.ctrlKey || event.metaKey || event.altKey ? null : actions[event.key];
    if (!action) return;
    event.preventDefault();
    action();
    this.draw();
  }

  draw() {
    const { width, height } = this.canvas, context = this.canvas.getContext("2d");
    const [a, b] = this.pictures, mode = this.mode.value;
    // Never beyond the edges of the image.
    this.left = Math.max(0, Math.min(this.left, this.size[0] - width / this.zoom));
    this.top = Math.max(0, Math.min(this.top, this.size[1] - height / this.zoom));
    this.gainLabel.hidden = mode !== "error";
    context.resetTransform();
    context.globalCompositeOperation = "source-over";
    context.clearRect(0, 0, width, height);
    context.imageSmoothingEnabled = this.zoom < 2;
    const put = (picture, image) => picture && context.drawImage(
        image ?? picture.image, -this.left * this.zoom, -this.top * this.zoom,
        this.size[0] * this.zoom, this.size[1] * this.zoom);
    if (mode === "error") {
      const same = a?.values && b?.values && a.values.width === b.values.width;
      if (same) {
        const key = this.gain.value;
        if (this.map?.key !== key) this.map = { key, image: errorMap(a, b, Number(key)) };
        put(a, this.map.image);
      } else if (a && b) {  // what can be drawn without reading: the plain difference
        put(a);
        context.globalCompositeOperation = "difference";
        put(b);
      }
    } else if (mode === "slider") {
      const split = width * this.slider.value / this.slider.max;
      put(b);
      context.save();
      context.beginPath();
      context.rect(0, 0, split, height);
      context.clip();
      context.clearRect(0, 0, split, height);
      put(a);
      context.restore();
      context.fillStyle = "#fff";
      context.fillRect(split - 1, 0, 2, height);
    } else {
      put(mode === "a" ? a : b);
    }
    this.label(context, mode);
  }

  label(context, mode) {
    const { width } = this.canvas;
    const name = list => list.selectedOptions[0]?.textContent ?? "";
    const write = (text, x, align) => {
      context.font = "15px sans-serif";
      context.textAlign = align;
      context.lineWidth = 3;
      context.strokeStyle = "#000";
      context.strokeText(text, x, 20);
      context.fillStyle = "#fff";
      context.fillText(text, x, 20);
    };
    if (mode === "slider" || mode === "a") write("A " + name(this.a), 8, "left");
    if (mode === "slider" || mode === "b") write("B " + name(this.b), width - 8, "right");
    if (mode === "error") write(`difference of A and B, times ${this.gain.value}`, 8, "left");
  }
}

function viewerOf(section) {
  const root = section.querySelector(".viewer");
  return root.viewer ??= new Viewer(root);
}

// Tables and viewers are built when first seen: a page may hold many sections.
const allSections = [...document.querySelectorAll("section[data-section]")];
const watcher = new IntersectionObserver(entries => {
  for (const { isIntersecting, target } of entries) {
    if (!isIntersecting) continue;
    watcher.unobserve(target);
    if (target.matches(".viewer")) viewerOf(sectionOf(target));
    else buildTable(sectionOf(target));
  }
}, { rootMargin: "200px" });
for (const element of document.querySelectorAll(".table, .viewer")) watcher.observe(element);

// What the address of the page says is shown: #scene=boxes&a=lucid&b=reference.
function restore() {
  const state = new URLSearchParams(location.hash.slice(1));
  if (!state.has("scene")) return;
  const section = allSections[(state.get("section") ?? 1) - 1];
  if (!section?.querySelector(".viewer")) return;
  const viewer = viewerOf(section);
  const setting = viewer.settings.findIndex(({ name }) => name === state.get("scene"));
  if (setting < 0) return;
  const place = list => viewer.settings[setting].pictures.findIndex(({ label }) => label === state.get(list));
  const [a, b] = [place("a"), place("b")];
  viewer.show(setting, Math.max(0, a), b < 0 ? undefined : b);
  viewer.root.scrollIntoView({ block: "nearest" });
}
addEventListener("hashchange", restore);
restore();

// The gallery of a section is filled when it is opened.
for (const gallery of document.querySelectorAll("details.gallery")) {
  gallery.addEventListener("toggle", () => {
    const room = gallery.querySelector(".galleries");
    if (room.childElementCount) return;
    const make = (tag, properties) => Object.assign(document.createElement(tag), properties);
    const settings = parsed(sectionOf(gallery), "settings");
    for (const { heading, pictures } of settings) {
      const grid = make("div", { className: "pictures" });
      for (const { label, error, parameters, picture, link, problem } of pictures) {
        const figure = make("figure", {}), caption = make("figcaption", {});
        if (problem) {
          figure.append(make("div", { className: "none", textContent: problem }));
        } else {
          const anchor = make("a", { href: link });
          anchor.append(make("img", { src: embedded[picture]?.uri ?? link, loading: "lazy",
                                      alt: `${heading}, drawn by ${label}` }));
          figure.append(anchor);
        }
        caption.append(make("strong", { textContent: label }), `: ${error}`);
        if (parameters) caption.append(make("br", {}), parameters);
        figure.append(caption);
        grid.append(figure);
      }
      room.append(make("h4", { textContent: heading }), grid);
    }
  });
}
