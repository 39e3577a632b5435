// Shows all figures of the page.

import { show } from "./figures.js";

for (const place of document.querySelectorAll("[data-figure]")) {
    show(place, place.dataset.figure).catch((error) => (place.textContent = `The figure cannot be shown. (${error?.message ?? error})`));
}
