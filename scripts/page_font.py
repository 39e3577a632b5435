#!/usr/bin/env python3
"""Write the typeface of the viewer's page: Ubuntu Light with Latin letters and the signs of the viewer alone, as small as it can be.

    pip install fonttools
    python3 scripts/page_font.py Ubuntu-Light.ttf crates/airlight-viewer/font/UbuntuLight-page.ttf

Source
  Ubuntu-Light.ttf   Ubuntu Font Family, Ubuntu Font Licence 1.0: the folder fonts of the crate epaint_default_fonts. The licence wants a
                     changed typeface to add "derivative" and a name of its own to the name.
"""

import sys

from fontTools import subset
from fontTools.ttLib import TTFont

RANGES = [(0x20, 0x7E), (0xA0, 0x17F), (0x218, 0x21B)]
"""Letters of languages with the Latin alphabet."""
SIGNS = "αβλμτ–—‘’“”•…′″₂→←↑↓−≈≠≤≥²³"
"""Other characters of the viewer."""
NAME = "Ubuntu Light derivative Airlight page"

if len(sys.argv) != 3:
    sys.exit(__doc__)
source, target = sys.argv[1:]

font = TTFont(source)
options = subset.Options(layout_features=["kern", "mark", "ccmp", "locl"], name_IDs=[0, 1, 2, 3, 4, 5, 6, 13, 14], notdef_outline=True)
# Widths of hinted pixels for devices, which the viewer does not read.
options.drop_tables += ["hdmx", "VDMX"]
subsetter = subset.Subsetter(options)
characters = {code for first, last in RANGES for code in range(first, last + 1)} | set(map(ord, SIGNS))
subsetter.populate(unicodes=characters)
subsetter.subset(font)
for record in font["name"].names:
    if record.nameID in (1, 3, 4):
        record.string = NAME
    elif record.nameID == 6:
        record.string = NAME.replace(" ", "-")
font.save(target)
