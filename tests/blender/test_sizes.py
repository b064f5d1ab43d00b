"""A region is as large and lies where it is seen, whatever was done to the bone: in the scene and in its file."""

from typing import Any

import numpy as np
import pytest
from conftest import Blender

PLACES = ["as made", "moved and turned", "twice as large", "mirrored", "sheared"]
THICKNESS_MM = 6.0


@pytest.fixture(scope="module")
def run(extension_zip: Any, ct: Any, tmp_path_factory: pytest.TempPathFactory) -> Any:
    """One Blender for all."""
    return Blender(extension_zip, tmp_path_factory.mktemp("sizes")).run("sizes", ct=ct)


@pytest.mark.parametrize("place", PLACES)
def test_the_region_is_on_the_patch_and_as_thick_as_asked(
    run: dict[str, Any], place: str
) -> None:
    region = run[place]
    assert region["off"] == 0.0
    seen, patch = np.array(region["seen"]), np.array(region["patch"])
    assert np.all(seen > patch - 1.0)
    # The patch is curved: its region is deeper than it by less than the whole thickness.
    assert np.all(seen < patch + THICKNESS_MM + 0.5)


@pytest.mark.parametrize("place", PLACES)
def test_its_file_is_as_large(run: dict[str, Any], place: str) -> None:
    region = run[place]
    # A bone that was only moved is saved where the patient is: turned otherwise, of the same size.
    expected = (
        run["as made"]["saved"] if place == "moved and turned" else region["seen"]
    )
    assert np.allclose(region["saved"], expected, atol=1e-3)


def test_a_flat_mesh_is_refused_with_its_remedy(run: dict[str, Any]) -> None:
    assert "scaled to nothing" in run["flat"]
    assert "Scale" in run["flat"]
