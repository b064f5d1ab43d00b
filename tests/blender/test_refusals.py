"""What cannot be done is refused with one line that names the remedy, and leaves nothing behind."""

import pytest
import refusal_texts

# What is asked for, and words that its answer must have.
CASES = [
    ("ct picker: a file", ["file.txt", "folder"]),
    ("ct picker: nothing there", ["does not exist", "choose"]),
    ("ct picker: a file that is not there", ["does not exist", "choose"]),
    ("mesh picker: a file", ["file.txt", "folder"]),
    ("mesh picker: nothing there", ["does not exist", "choose"]),
    ("ct picker: no choice", ["no folder is chosen", "choose"]),
    ("mesh picker: no choice", ["no folder is chosen", "choose"]),
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
    ("no view to cut along", ["no 3D view", "choose another direction"]),
    ("region of a mesh with fewer vertices", ["fewer vertices", "select on it anew"]),
    ("region of a mesh that is gone", ["for the tools", "is gone", "undo"]),
    ("region that does not say how", ["no longer says", "select on the bone anew"]),
    ("nothing to compare", ["Select two meshes"]),
    ("nothing to export", ["Make the mesh object", "active"]),
    ("nothing with faults", ["Make the mesh object", "active"]),
    ("nothing to render again", ["Make a bone active"]),
    ("nothing to look at", ["no mesh to look at"]),
    ("no slices to remove", ["no CT slices"]),
    ("no crop box to use", ["Show Crop Box"]),
    ("no crop box to remove", ["Show Crop Box"]),
    ("no images for a crop box", ["Select File Directory of CT Images"]),
    ("no images for slices", ["Select File Directory of CT Images"]),
    ("no images to look at again", ["Select File Directory of CT Images"]),
    ("images for a crop box not looked at", ["Look Again"]),
    ("crop box away from the images", ["no voxel", "Show Crop Box"]),
    ("crop box without a place", ["not a box", "Show Crop Box"]),
    ("compared with nothing", ["select the mesh to compare with", "Ctrl"]),
    ("compared with two", ["more than two", "select the two"]),
    ("compared in Edit Mode", ["leave Edit Mode", "Tab"]),
    ("compared and changed", ["three", "changed meanwhile", "press the button"]),
    ("faults of a changed mesh", ["one", "changed meanwhile", "press the button"]),
    ("plane through a line", ["in a line", "select three that do not"]),
    ("settings of other images", ["elsewhere", "other images", "choose their folder"]),
    ("settings of no file", ["no file is chosen", "bone.stl.json"]),
    ("settings of a folder", ["no file is chosen", "bone.stl.json"]),
    ("settings of another file", ["other.json", "choose a file such as"]),
    ("settings of another version", ["Method", "newer", "another version"]),
    ("exported as a device", ["con", "reserved by Windows", "another name"]),
    ("exported with a long name", ["Filename", "too long", "200 letters at most"]),
    ("a flat mesh", ["scaled to nothing", "Scale"]),
    ("exported where nothing can be written", ["cannot be written to", "another"]),
    ("checked while rendering", ["Render Surface Mesh", "running", "press Cancel"]),
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


def test_every_refusal_of_the_addon_was_seen(refusals: dict[str, str]) -> None:
    of_addon = refusal_texts.of_addon()
    assert len(of_addon) > 40, "the source is not read any more"
    unseen = [
        f"{refusal.place}: {refusal.pattern.pattern}"
        for refusal in of_addon
        if not any(refusal.pattern.search(message) for message in refusals.values())
    ]
    assert not unseen


def test_a_refused_request_leaves_no_file(refusals: dict[str, str]) -> None:
    assert refusals["files after the refused renderings"] == ""
    assert refusals["files after the refused regions"] == "bone.stl, bone.stl.json"
