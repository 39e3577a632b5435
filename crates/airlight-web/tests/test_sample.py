"""The engines compute in the browser what they compute on the processor."""

import os
import subprocess

import pytest

SAMPLE = """async () => {
    const module = await import("./airlight_web.js");
    await module.default();
    return module.sample_values();
}"""
# By the first word of the name, where the libraries of exponentials and the like differ in their last bits.
LARGEST = {"monte": 1e-9, "fog": 1e-6}


def values(text):
    rows = (line.rsplit(" ", 1) for line in text.splitlines())
    return {name: float(value) for name, value in rows}


@pytest.fixture(scope="module")
def native():
    return values(subprocess.run([os.environ["AIRLIGHT_SAMPLE"]], check=True, capture_output=True, text=True).stdout)


def test_values_are_those_of_the_processor(browser, address, native):
    page = browser.new_page()
    page.goto(address + "blank.html")
    got = values(page.evaluate(SAMPLE))
    assert got.keys() == native.keys()
    assert len(got) > 150
    for name, value in native.items():
        assert got[name] == pytest.approx(value, rel=LARGEST.get(name.split()[0], 1e-7)), name
    page.close()
