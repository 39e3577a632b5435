// Shows the viewer, or a sentence why there is none.

import init, { start } from "./airlight_web.js";

const note = document.getElementById("note");

// The viewer writes the address without this event: a person has changed it.
addEventListener("hashchange", () => location.reload());

try {
    await init();
    await start(document.getElementById("canvas"), location.hash.slice(1));
    note.remove();
} catch (error) {
    const sentence = typeof error === "string" ? error : (error?.message ?? String(error));
    note.textContent = `The viewer cannot start. It needs WebAssembly, and WebGPU or WebGL 2. (${sentence})`;
}
