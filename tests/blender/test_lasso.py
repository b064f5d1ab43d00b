"""Select with Lasso hides the edges that would cover the bone, and brings them back."""

from pathlib import Path
from typing import Any

import pytest
from conftest import Blender


@pytest.fixture(scope="module")
def run(
    extension_zip: Path, ct: Path, tmp_path_factory: pytest.TempPathFactory
) -> dict[str, Any]:
    return Blender(extension_zip, tmp_path_factory.mktemp("lasso")).run("lasso", ct=ct)


@pytest.mark.parametrize("case", ["drawing", "from edit mode"])
def test_nothing_but_edges_is_hidden_and_faces_are_selected(
    run: dict[str, Any], case: str
) -> None:
    seen = run[case]
    assert seen["mode"] == "EDIT"
    assert seen["edges"] == seen["of edges"] > 0
    assert seen["vertices"] == seen["faces"] == 0
    assert seen["modes"] == [False, False, True]


def test_what_is_selected_can_be_cut_out_and_stays_selected(
    run: dict[str, Any],
) -> None:
    assert run["selected"] == run["still selected"] == run["selected after"] > 100
    assert run["cut"] == ["FINISHED"]
    assert run["region"] > run["selected"]


@pytest.mark.parametrize("case", ["after", "by tab"])
def test_edges_are_back_when_edit_mode_was_left(run: dict[str, Any], case: str) -> None:
    seen = run[case]
    assert seen["edges"] == seen["vertices"] == seen["faces"] == 0


def test_nothing_of_it_stays_with_the_mesh(run: dict[str, Any]) -> None:
    assert run["names"] == []
