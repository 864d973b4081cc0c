"""Results show their page in a notebook."""

import html
import re

import pytest
import slider_crank as sc


def results(data):
    scene = sc.Scene.duarte()
    yield sc.simulate(scene)
    yield sc.kinematics(scene)
    yield sc.statics(scene, torque="1 N m")
    yield sc.sweep(scene, {"geometry.rod": "150mm:160mm:3"})
    yield sc.inverse(scene, data / "duarte-motion.csv")


def test_each_result_is_a_frame_of_its_page(data):
    for result in results(data):
        shown = result._repr_html_()
        frame = re.fullmatch(r'<iframe srcdoc="([^"]*)" [^<>]*></iframe>', shown)
        assert frame, shown[:100]
        page = html.unescape(frame[1])
        assert page.lstrip().lower().startswith("<!doctype html>") and page.rstrip().endswith("</html>")
        assert "Duarte 2018 Diesel engine" in page and "src=" not in page.split("<script")[0]


def test_a_page_of_too_many_designs_is_refused():
    found = sc.sweep(sc.Scene.duarte(), {"geometry.rod": "150mm:160mm:50001"}, motion=False)
    assert len(found["stroke_m"]) == 50001
    with pytest.raises(sc.Refused, match="50000 designs at most"):
        found.page()
