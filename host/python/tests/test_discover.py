"""A law that the library lacks, from motions to a model that holds it."""

import pytest
from conftest import measured

import handstand as hs

LAW = """
[[expression]]
name = "stiffening"
torque = "-c * q^3"
parameter = [{ key = "c", unit = "N m/rad^3", start = 0.1, low = 0.0, high = 1.0 }]

[[effect]]
kind = "stiffening"
joint = 1
c = 0.08
"""


def test_a_cubic_spring_is_discovered(model: hs.Model) -> None:
    truth = hs.Model.parse(model.toml + LAW)
    motions = [measured(truth, seed) for seed in (1, 2, 3)]
    found = hs.discover(model, motions[:2], holdout=motions[2], terms=1)
    assert found.verdict in ("found", "ambiguous")
    assert found.terms[0].startswith("joint 1: torque = ") and "q" in found.terms[0]
    assert found.terms[0] in str(found)
    assert found.to_dict()["terms"][0]["joint"] == 1
    page = found.html()
    assert 'id="law"' in page and "torque" in page
    assert "<iframe" in found._repr_html_()
    assert found.model is not None
    before, after = (hs.compare(m, motions[2]).rms[0] for m in (model, found.model))
    assert after < 0.1 * before

    with pytest.raises(hs.HandstandError, match="give 1, 2 or 3"):
        hs.discover(model, motions[:2], terms=4)
