// The time line: key frames of the parameters, played in the page, and written by `kfrac animate`.

const $ = (id) => document.getElementById(id);
let page = null; // what the rest of the page lends: tab, json, make, state, look, values, changed, say
let playing = 0;

export function start(lent) {
  page = lent;
}
// The look is another object after each picture.
const film = () => (page.look().film ??= { keys: [] });
/** Changes the key frames. */
const edit = (change) => {
  stop();
  change(film());
  page.changed();
  show();
};

/** Shows the time line, for a file with parameters. */
export function show() {
  const { make } = page;
  const now = film();
  const { keys } = now;
  const has = page.state().parameters?.length > 0;
  $("film").hidden = !has;
  if (!has) return;
  const knob = (key, at) => {
    const words = Object.entries(key).map(([name, value]) => `${name} = ${value}`).join(", ");
    const mark = make("button", { type: "button", className: "key", title: `${words}\nDrag to move it, Delete removes it`, "aria-label": `Key frame ${at + 1}: ${words}` }, String(at + 1));
    mark.style.left = `${keys.length > 1 ? (100 * at) / (keys.length - 1) : 0}%`;
    const to = (next) => {
      if (next === at || next < 0 || next >= keys.length) return;
      edit(({ keys }) => keys.splice(next, 0, ...keys.splice(at, 1)));
      $("film-line").children[next].focus();
    };
    mark.onclick = () => {
      stop();
      Object.assign(page.look().set, key);
      page.changed();
    };
    mark.onkeydown = (event) => {
      const by = { ArrowLeft: -1, ArrowRight: 1 }[event.key];
      if (by) to(at + by);
      else if (event.key === "Delete" || event.key === "Backspace") {
        edit(({ keys }) => keys.splice(at, 1));
      } else return;
      event.preventDefault();
      event.stopPropagation();
    };
    mark.onpointerdown = (event) => mark.setPointerCapture(event.pointerId);
    const share = (event) => {
      const box = $("film-line").getBoundingClientRect();
      return Math.max(0, Math.min(1, (event.clientX - box.left) / box.width));
    };
    mark.onpointermove = (event) => event.buttons && (mark.style.left = `${100 * share(event)}%`);
    mark.onpointerup = (event) => {
      to(Math.round(share(event) * (keys.length - 1)));
      mark.style.left = `${keys.length > 1 ? (100 * at) / (keys.length - 1) : 0}%`;
    };
    return mark;
  };
  $("film-line").replaceChildren(...keys.map(knob));
  $("film-play").disabled = $("film-export").disabled = keys.length < 2;
  for (const control of $("film").querySelectorAll("[data-film]")) {
    const { film: name } = control.dataset;
    if (control.type === "checkbox") control.checked = Boolean(now[name]);
    else control.value = now[name] ?? control.defaultValue ?? "";
    control.onchange = () => {
      edit((it) => (it[name] = control.type === "checkbox" ? control.checked : control.type === "number" ? +control.value : control.value));
    };
  }
  $("film-add").onclick = () => edit(({ keys }) => keys.push(page.values()));
  $("film-play").onclick = () => {
    if (!playing) return play();
    stop();
    page.changed();
  };
}

/** Returns the values of every frame, and the command of the film. */
export const frames = () => page.json("POST", "/film", { tab: page.tab, look: page.look() });

async function play() {
  try {
    const { sets } = await frames();
    const begun = performance.now();
    $("film-play").textContent = "Stop";
    const rate = film().fps ?? 30;
    let last = -1;
    const step = () => {
      const at = Math.floor(((performance.now() - begun) / 1000) * rate) % sets.length;
      if (at !== last) {
        Object.assign(page.look().set, sets[at]);
        page.changed(true);
      }
      last = at;
      playing = requestAnimationFrame(step);
    };
    playing = requestAnimationFrame(step);
  } catch (error) {
    page.say(error.message);
  }
}
export function stop() {
  cancelAnimationFrame(playing);
  playing = 0;
  $("film-play").textContent = "Play";
}
