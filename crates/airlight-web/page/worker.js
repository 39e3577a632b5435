// Computes answers for the viewer: the first message is the compiled module, each other one a request.

import init, { answer } from "./airlight_web.js";

let ready;

addEventListener("message", async ({ data }) => {
    if (data instanceof WebAssembly.Module) {
        ready = init({ module_or_path: data });
        return;
    }
    await ready;
    const bytes = answer(data);
    postMessage(bytes, [bytes.buffer]);
});
