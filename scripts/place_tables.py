#!/usr/bin/env python3
"""Write the cities and the land that the viewer's choice of a place embeds.

    python3 scripts/place_tables.py cities ne_50m_populated_places.json zone.tab iso3166.tab data/cities.csv
    python3 scripts/place_tables.py land   ne_110m_land.json                                 data/land.txt

(output paths relative to crates/airlight-viewer/)

Sources, all in the public domain
  ne_50m_populated_places, ne_110m_land   Natural Earth 4.1, https://www.naturalearthdata.com, as GeoJSON.
  zone.tab, iso3166.tab                   IANA time zone database, https://www.iana.org/time-zones: on most systems in
                                          /usr/share/zoneinfo.
"""

import json
import math
import re
import sys

POPULATION = 1.6e6
"""Inhabitants from which on a city is listed; capitals always are."""
LISTED = {
    "Amundsen–Scott South Pole Station", "Anchorage", "Bergen", "Brisbane", "Cusco", "Edinburgh", "Fairbanks", "Geneva", "Hamburg",
    "Honolulu", "Longyearbyen", "Marseille", "McMurdo Station", "Munich", "Murmansk", "Nuuk", "Papeete", "Perth",
    "Punta Arenas", "Stanley", "Tromsø", "Utqiaġvik", "Vancouver", "Zurich",
}
"""Smaller places in far latitudes or known to many."""
NAMES = {
    "AmundseniScott South Pole Station": "Amundsen–Scott South Pole Station", "Kiev": "Kyiv", "Makkah": "Mecca", "New York": "New York",
    "Rangoon": "Yangon", "Ōsaka": "Osaka",
}
"""Names that differ from the English ones of Natural Earth."""
SPURIOUS = {
    "AmundseniScott South Pole Station", "Ciudad de Guatemala (Guatemala City)", "Ciudad de M", "Ciudad de Panam", "Dongguan", "El Djazacr",
    "H", "Hai Phnng", "Inch`on", "N'Djamnna", "Shenyeng", "Shijianzhuang", "Sio Paulo", "T'aichung", "T'Bilisi",
    "Th nh Pho Ho Chy Minh", "USA", "rumqi",
}
"""Other names that have lost letters in the source, or are those of other places."""
TOLERANCE_DEG = 0.25
"""Largest distance of simplified coasts from those of the source."""
SMALLEST_DEG2 = 0.6
"""Area of the smallest island."""


def rows_of(path):
    """Rows of fields of a table of the time zone database."""
    with open(path, encoding="utf-8") as file:
        return [line.rstrip("\n").split("\t") for line in file if not line.startswith("#")]


def degrees(text):
    """An angle of zone.tab, +DDMM or +DDDMM with or without seconds."""
    sign, digits = text[0], text[1:]
    seconds = len(digits) > 5
    parts = [digits[:-4], digits[-4:-2], digits[-2:]] if seconds else [digits[:-2], digits[-2:]]
    value = sum(int(part) / 60**k for k, part in enumerate(parts))
    return -value if sign == "-" else value


def zones(path):
    """Time zones by country: name, latitude, longitude."""
    found = {}
    for code, place, name, *_ in rows_of(path):
        latitude, longitude = re.fullmatch(r"([+-]\d+)([+-]\d+)", place).groups()
        found.setdefault(code, []).append((name, degrees(latitude), degrees(longitude)))
    return found


def apart(a, b):
    """Angle between two places, radians."""
    (north, east), (other_north, other_east) = (map(math.radians, place) for place in (a, b))
    cosine = math.sin(north) * math.sin(other_north) + math.cos(north) * math.cos(other_north) * math.cos(east - other_east)
    return math.acos(max(-1.0, min(1.0, cosine)))


def zone_of(place, country, stated, by_country):
    """The stated zone if the country has it, else the one whose city is the nearest."""
    # Without a country in the table, and for the south pole, where all meridians meet.
    if country not in by_country or place[0] < -89:
        return stated or "Antarctica/McMurdo"
    names = [name for name, *_ in by_country[country]]
    if stated in names:
        return stated
    return min(by_country[country], key=lambda zone: apart(place, zone[1:]))[0]


def cities(source, zone_table, country_table, path):
    by_country = zones(zone_table)
    countries = dict(rows_of(country_table))
    with open(source, encoding="utf-8") as file:
        places = [feature["properties"] for feature in json.load(file)["features"]]
    places.sort(key=lambda place: -place["POP_MAX"])
    rows = []
    for place in places:
        english = NAMES.get(place["NAME"]) or place["NAME_EN"] or place["NAME"]
        english = NAMES.get(english, english)
        is_capital = place["FEATURECLA"] == "Admin-0 capital"
        if not (is_capital or place["POP_MAX"] >= POPULATION or english in LISTED):
            continue
        country = countries.get(place["ISO_A2"], place["ADM0NAME"])
        where = (place["LATITUDE"], place["LONGITUDE"])
        zone = zone_of(where, place["ISO_A2"], place["TIMEZONE"], by_country)
        stated = "|".join(place[key] or "" for key in ("NAME", "NAMEPAR", "NAMEALT"))
        others = sorted(set(re.split(r"\||, .*?(?:\||$)", stated)) - SPURIOUS - {english, ""})
        rows.append([english, "/".join(others), country, f"{where[0]:.2f}", f"{where[1]:.2f}", zone])
    header = [
        "Cities by population: name, other names, country, latitude and longitude in degrees north and east, time zone.",
        "Natural Earth 4.1 (https://www.naturalearthdata.com) and IANA time zone database, both in the public domain.",
        "Written by scripts/place_tables.py.",
    ]
    with open(path, "w", encoding="utf-8", newline="\n") as out:
        out.writelines(f"# {line}\n" for line in header)
        for row in rows:
            assert not any(";" in field for field in row), row
            out.write(";".join(row) + "\n")


def simplified(points):
    """A line with fewer points (Douglas and Peucker 1973)."""
    if len(points) < 3:
        return points
    (x0, y0), (x1, y1) = points[0], points[-1]
    length = math.hypot(x1 - x0, y1 - y0)

    def distance(point):
        x, y = point
        if length == 0:
            return math.hypot(x - x0, y - y0)
        return abs((x1 - x0) * (y - y0) - (y1 - y0) * (x - x0)) / length

    farthest = max(range(1, len(points) - 1), key=lambda k: distance(points[k]))
    if distance(points[farthest]) < TOLERANCE_DEG:
        return [points[0], points[-1]]
    return simplified(points[: farthest + 1])[:-1] + simplified(points[farthest:])


def area(ring):
    pairs = zip(ring, ring[1:] + ring[:1])
    return abs(sum(x0 * y1 - x1 * y0 for (x0, y0), (x1, y1) in pairs)) / 2


def land(source, path):
    with open(source, encoding="utf-8") as file:
        polygons = [feature["geometry"]["coordinates"] for feature in json.load(file)["features"]]
    rings = [[tuple(point[:2]) for point in ring] for polygon in polygons for ring in polygon]
    header = [
        "Land of the Earth: a closed line a row, longitude and latitude of its points in tenths of degrees; lines inside others are lakes.",
        "Natural Earth 4.1, 1:110m land (https://www.naturalearthdata.com), public domain. Written by scripts/place_tables.py.",
    ]
    with open(path, "w", encoding="ascii", newline="\n") as out:
        out.writelines(f"# {line}\n" for line in header)
        for ring in rings:
            if area(ring) < SMALLEST_DEG2:
                continue
            points = simplified(ring)[:-1]
            out.write(" ".join(f"{round(10 * v)}" for point in points for v in point) + "\n")


if __name__ == "__main__":
    match sys.argv[1:]:
        case ["cities", source, zone_table, country_table, path]:
            cities(source, zone_table, country_table, path)
        case ["land", source, path]:
            land(source, path)
        case _:
            sys.exit(__doc__)
