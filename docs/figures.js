// The live figures of a book that stands beside the viewer's page (scripts/web); without the page they stay hidden.
for (const place of document.querySelectorAll("[data-figure]")) {
    import(new URL("../figures.js", location.href))
        .then(({ show }) => show(place, place.dataset.figure))
        .then(() => (place.hidden = false))
        .catch(() => {});
}
