// The book's live figures: curves that the library computes as the reader moves the sliders.

import init, { height_fog, phase_function } from "./airlight_web.js";

const [WIDTH, HEIGHT, LEFT, RIGHT, BOTTOM] = [640, 300, 56, 20, 34];
const COUNT = 201;
const COLOURS = ["#b3541e", "#1f6f8b", "#3d3d3d"];

const FIGURES = {
    "phase-function": {
        title: "Phase function, 1/sr",
        across: { name: "scattering angle", from: 0, to: 180, step: 30, unit: "°" },
        up: { from: -3, to: 2 },
        sliders: [
            { name: "g", from: -0.9, to: 0.95, step: 0.01, value: 0.8 },
            { name: "α", from: 0, to: 1, step: 0.01, value: 0 },
        ],
        names: ["Draine; with α = 0 Henyey and Greenstein", "isotropic"],
        curves: ([g, alpha]) => [...phase_function(g, alpha, COUNT), ...phase_function(0, 0, COUNT)],
    },
    "height-fog": {
        title: "Light of the fog, 1/sr, towards the azimuth of the sun",
        across: { name: "elevation", from: -10, to: 90, step: 10, unit: "°" },
        up: { from: -3, to: 1 },
        sliders: [
            { name: "visibility, m", from: 50, to: 2000, step: 10, value: 250 },
            { name: "scale height, m", from: 5, to: 200, step: 1, value: 15 },
            { name: "elevation of the sun, °", from: 2, to: 60, step: 1, value: 8 },
        ],
        names: ["as printed", "with sunlight attenuated", "with all orders of scattering"],
        curves: (values) => height_fog(...values, COUNT),
    },
};

function element(name, attributes, ...children) {
    const isDrawn = ["svg", "path", "text", "line"].includes(name);
    const made = isDrawn ? document.createElementNS("http://www.w3.org/2000/svg", name) : document.createElement(name);
    for (const [key, value] of Object.entries(attributes)) made.setAttribute(key, value);
    made.append(...children);
    return made;
}

// Places of a figure in its picture: across linear, up in powers of ten.
function places({ across, up }) {
    const x = (value) => LEFT + ((value - across.from) / (across.to - across.from)) * (WIDTH - LEFT - RIGHT);
    const y = (power) => HEIGHT - BOTTOM - ((power - up.from) / (up.to - up.from)) * (HEIGHT - BOTTOM - 10);
    return { x, y };
}

function axes(figure) {
    const { x, y } = places(figure);
    const { across, up } = figure;
    const parts = [];
    const text = (attributes, value) => parts.push(element("text", { fill: "currentColor", "font-size": 12, ...attributes }, value));
    const line = (attributes) => parts.push(element("line", { stroke: "currentColor", "stroke-opacity": 0.2, ...attributes }));
    for (let value = across.from; value <= across.to; value += across.step) {
        line({ x1: x(value), x2: x(value), y1: y(up.from), y2: y(up.to) });
        text({ x: x(value), y: HEIGHT - BOTTOM + 14, "text-anchor": "middle" }, `${value}${across.unit}`);
    }
    for (let power = up.from; power <= up.to; power++) {
        line({ x1: x(across.from), x2: x(across.to), y1: y(power), y2: y(power) });
        text({ x: LEFT - 6, y: y(power) + 4, "text-anchor": "end" }, String(Number(`1e${power}`)));
    }
    text({ x: (LEFT + WIDTH - RIGHT) / 2, y: HEIGHT - 4, "text-anchor": "middle" }, across.name);
    return parts;
}

function path(figure, values) {
    const { x, y } = places(figure);
    const { from, to } = figure.across;
    const { up } = figure;
    const points = Array.from(values, (value, k) => {
        const power = Math.min(Math.max(Math.log10(value), up.from), up.to);
        return `${x(from + ((to - from) * k) / (COUNT - 1)).toFixed(1)},${y(power).toFixed(1)}`;
    });
    return `M${points.join("L")}`;
}

// Fills an element with a figure of a name, once the library is there.
export async function show(into, name) {
    await init();
    const figure = FIGURES[name];
    const lines = figure.names.map((_, k) => element("path", { fill: "none", stroke: COLOURS[k], "stroke-width": 2 }));
    const svg = element("svg", { viewBox: `0 0 ${WIDTH} ${HEIGHT}`, role: "img", "aria-label": figure.title }, ...axes(figure), ...lines);
    const inputs = figure.sliders.map(({ from, to, step, value }) => element("input", { type: "range", min: from, max: to, step, value }));
    const outputs = inputs.map(() => element("output", {}));
    const draw = () => {
        const values = inputs.map((input) => input.valueAsNumber);
        outputs.forEach((output, k) => (output.textContent = ` ${values[k]}`));
        const curves = figure.curves(values);
        lines.forEach((line, k) => line.setAttribute("d", path(figure, curves.slice(k * COUNT, (k + 1) * COUNT))));
    };
    const controls = figure.sliders.map(({ name }, k) => element("label", {}, `${name} `, inputs[k], outputs[k]));
    inputs.forEach((input) => input.addEventListener("input", draw));
    const legend = figure.names.map((name, k) => element("span", { style: `color: ${COLOURS[k]}` }, name));
    into.replaceChildren(element("p", {}, figure.title), svg, element("p", { class: "legend" }, ...legend), element("p", { class: "sliders" }, ...controls));
    draw();
}
