"""The advisor's validation: the scenes drawn at random, and a part of the study."""

import pytest
from campaigns import Here

from comparisons.models.scales import scales
from comparisons.runs.campaign import campaign
from sheetbench import scenes
from studies.advisor import study as advisor_study
from studies.advisor.study import scenes_at_random, study


def test_scenes_drawn_are_the_same_for_the_same_seed_and_within_range():
    drawn = [scene for scene, _ in zip(scenes_at_random(3), range(40), strict=False)]
    again = [scene for scene, _ in zip(scenes_at_random(3), range(40), strict=False)]
    assert drawn == again and len({scene.sheet for scene in drawn}) == 40
    for scene in drawn:
        scenes.require_static(scene)
        found = scales(scene)
        assert 0.003 <= found.slenderness <= 0.05
        assert 0.0 < found.load_number < 200.0
    assert len({tuple(s.kind for s in scene.supports) for scene in drawn}) >= 6


@pytest.mark.usefixtures("in_process")
def test_a_few_random_scenes(tmp_path, monkeypatch):
    rivals = advisor_study.rows
    monkeypatch.setattr(advisor_study, "rows", lambda scene: rivals(scene)[1::4])
    with campaign(tmp_path) as store:
        found, again = (
            study(store, count=2, compared=1, tolerances=(0.02,), elements=8, pool=Here) for _ in range(2)
        )
    assert len(found.cases) == 2 and found.met == 1.0
    assert found == again
    assert found.cases[0]["cost_ratio"] is not None
    assert "tolerance" in found.tables()[0].to_markdown()


@pytest.mark.slow
def test_sixty_random_scenes(tmp_path):
    with campaign(tmp_path) as store:
        found = study(store, workers=2)
    assert len(found.cases) == 60 * len(advisor_study.TOLERANCES)
    assert found.met >= 0.95
    assert found.within >= 0.80
