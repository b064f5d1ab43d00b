"""What cannot be done is refused with one line that names the remedy, and leaves nothing behind."""

import pytest

# What is asked for, and words that its answer must have.
CASES = [
    ("ct picker: a file", ["file.txt", "folder"]),
    ("ct picker: nothing there", ["does not exist", "choose"]),
    ("ct picker: a file that is not there", ["does not exist", "choose"]),
    ("mesh picker: a file", ["file.txt", "folder"]),
    ("mesh picker: nothing there", ["does not exist", "choose"]),
    ("no ct folder", ["Select File Directory of CT Images"]),
    ("ct images are a file without any", ["file.txt", "not a DICOM file", "folder"]),
    ("ct folder is gone", ["does not exist"]),
    ("ct folder is empty", ["empty"]),
    ("ct folder without images", ["broken"]),
    ("no output folder", ["Select File Location to Save Mesh"]),
    ("output folder is a file", ["file.txt", "folder"]),
    ("output folder is gone", ["does not exist"]),
    ("no mesh name", ["Mesh Filename", "name"]),
    ("mesh name leaves the folder", ["../bone", "no plain file name"]),
    ("mesh name with a backslash", ["no plain file name"]),
    ("mesh name is absolute", ["no plain file name"]),
    ("mesh name is dots", ["no plain file name"]),
    ("nothing above the threshold", ["threshold"]),
    ("crop is no box", ["left half"]),
    ("no such series", ["17"]),
    ("no active mesh", ["active"]),
    ("nothing to check", ["active"]),
    ("nothing to mirror", ["active"]),
    ("nothing to measure", ["active"]),
    ("nothing for a plane", ["active"]),
    ("nothing for the lasso", ["active"]),
    ("no region to take up", ["region of interest", "active"]),
    ("no selection to measure", ["bone", "lasso"]),
    ("no selection in Edit Mode", ["no vertex is selected", "lasso"]),
    ("no selection to mirror in Edit Mode", ["no vertex is selected", "lasso"]),
    ("no selection to measure in Edit Mode", ["no vertex is selected", "lasso"]),
    ("no selection for a plane in Edit Mode", ["no vertex is selected", "lasso"]),
    ("too many for a plane", ["select exactly three"]),
    ("mirrored without a name", ["Segmented Mesh Filename"]),
    ("a mesh without slices", ["not made of slices", "method alpha", "Advanced"]),
    ("no selection", ["bone", "lasso"]),
    ("no region name", ["Segmented Mesh Filename"]),
    ("region name leaves the folder", ["../region", "no plain file name"]),
    ("region name is the mesh's", ["overwrite", "Segmented Mesh Filename"]),
    ("no output folder for the region", ["Select File Location to Save Mesh"]),
    ("output folder for the region is gone", ["does not exist"]),
    ("thickness 0", ["Thickness of Cut (mm)"]),
    ("a camera is active", ["active"]),
    ("mesh without vertices", ["no vertex"]),
]


@pytest.mark.parametrize(("case", "words"), CASES, ids=[case for case, _ in CASES])
def test_a_refusal_is_one_line_with_its_remedy(
    refusals: dict[str, str], case: str, words: list[str]
) -> None:
    message = refusals[case]
    assert message, f"{case} was not refused"
    assert "\n" not in message
    for word in words:
        assert word in message


def test_every_refusal_is_looked_at(refusals: dict[str, str]) -> None:
    assert {c for c in refusals if not c.startswith("files")} == {
        case for case, _ in CASES
    }


def test_a_refused_request_leaves_no_file(refusals: dict[str, str]) -> None:
    assert refusals["files after the refused renderings"] == ""
    assert refusals["files after the refused regions"] == "bone.stl, bone.stl.json"
