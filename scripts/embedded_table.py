"""Writer for the tables that the crates embed: header lines, each after a `#`, then rows of fields."""


def write(path, header, rows):
    with open(path, "w", encoding="ascii", newline="\n") as out:
        for line in header:
            out.write(f"# {line}\n")
        for row in rows:
            out.write(" ".join(row) + "\n")
