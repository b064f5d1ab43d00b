"""Every request that cannot be carried out, and what is answered."""

from pathlib import Path
from typing import Any

import bpy
import refusals_of_tools
import stage

LONG_AGO = "there/is/nothing/here"


def rendering(**fields: Any) -> str:
    """The error of a rendering with these fields, everything else being right."""
    before = {name: getattr(bpy.context.scene.bonemesh, name) for name in fields}
    for name, value in fields.items():
        setattr(bpy.context.scene.bonemesh, name, value)
    message = stage.message_of(bpy.ops.bonemesh.render_surface_mesh)
    for name, value in before.items():
        setattr(bpy.context.scene.bonemesh, name, value)
    return message


def region(**fields: Any) -> str:
    """The error of a region with these fields, everything else being right."""
    before = {name: getattr(bpy.context.scene.bonemesh, name) for name in fields}
    for name, value in fields.items():
        setattr(bpy.context.scene.bonemesh, name, value)
    message = stage.message_of(bpy.ops.bonemesh.select_roi)
    for name, value in before.items():
        setattr(bpy.context.scene.bonemesh, name, value)
    return message


def select(placed: Any, flag: bool) -> None:
    """Selects or deselects every vertex in Edit Mode and comes back."""
    bpy.ops.object.mode_set(mode="EDIT")
    bpy.ops.mesh.select_all(action="SELECT" if flag else "DESELECT")
    bpy.ops.object.mode_set(mode="OBJECT")


def pickers(folder: Path) -> dict[str, str]:
    """What the folder pickers refuse."""
    ops = bpy.ops.bonemesh
    file = folder / "file.txt"
    file.write_text("no folder")
    return {
        "ct picker: a file": stage.message_of(
            ops.choose_ct_directory, directory=str(file)
        ),
        "ct picker: nothing there": stage.message_of(
            ops.choose_ct_directory, directory=LONG_AGO
        ),
        "ct picker: a file that is not there": stage.message_of(
            ops.choose_ct_directory, filepath=LONG_AGO, directory=str(folder)
        ),
        "mesh picker: a file": stage.message_of(
            ops.choose_mesh_directory, directory=str(file)
        ),
        "mesh picker: nothing there": stage.message_of(
            ops.choose_mesh_directory, directory=LONG_AGO
        ),
        "ct picker: no choice": stage.message_of(ops.choose_ct_directory, directory=""),
        "mesh picker: no choice": stage.message_of(
            ops.choose_mesh_directory, directory=""
        ),
    }


def renderings(folder: Path) -> dict[str, str]:
    """What rendering refuses."""
    empty = folder / "empty"
    empty.mkdir()
    broken = folder / "broken"
    broken.mkdir()
    (broken / "image.dcm").write_bytes(b"no image")
    return {
        "no ct folder": rendering(ct_directory=""),
        "ct images are a file without any": rendering(
            ct_directory=str(folder / "file.txt")
        ),
        "ct folder is gone": rendering(ct_directory=LONG_AGO),
        "ct folder is empty": rendering(ct_directory=str(empty)),
        "ct folder without images": rendering(ct_directory=str(broken)),
        "no output folder": rendering(mesh_directory=""),
        "output folder is a file": rendering(mesh_directory=str(folder / "file.txt")),
        "output folder is gone": rendering(mesh_directory=LONG_AGO),
        "no mesh name": rendering(mesh_name="  "),
        "mesh name leaves the folder": rendering(mesh_name="../bone"),
        "mesh name with a backslash": rendering(mesh_name="a\\bone"),
        "mesh name is absolute": rendering(mesh_name=str(folder / "bone")),
        "mesh name is dots": rendering(mesh_name=".."),
        "nothing above the threshold": rendering(hu_threshold=3071),
        "crop is no box": rendering(crop="left half"),
        "no such series": rendering(series="17"),
    }


def regions(folder: Path) -> dict[str, str]:
    """What cutting a region out refuses."""
    answers = {}
    for other in list(bpy.data.objects):
        bpy.data.objects.remove(other)
    answers["no active mesh"] = region()
    ops = bpy.ops.bonemesh
    for case, operator in {
        "nothing to check": ops.check_mesh,
        "nothing to mirror": ops.mirror_roi,
        "nothing to measure": ops.measure_thickness,
        "nothing for a plane": ops.plane_from_vertices,
        "nothing for the lasso": ops.start_lasso,
        "no region to take up": ops.resume_roi,
    }.items():
        answers[case] = stage.message_of(operator)
    bpy.context.scene.bonemesh.mesh_name = "bone"
    bpy.ops.bonemesh.render_surface_mesh()
    stage.select_front(bpy.context.view_layer.objects.active)
    bpy.context.scene.bonemesh_region.method = "thesis"
    answers["a mesh without slices"] = region()
    bpy.context.scene.bonemesh_region.method = "solid"
    bpy.context.scene.bonemesh.method = "alpha"
    bpy.ops.bonemesh.render_surface_mesh()
    bone = bpy.context.view_layer.objects.active
    select(bone, False)
    answers["no selection"] = region()
    answers["no selection to measure"] = stage.message_of(ops.measure_thickness)
    answers |= without_selection()
    select(bone, True)
    answers["too many for a plane"] = stage.message_of(ops.plane_from_vertices)
    answers["mirrored without a name"] = mirrored_without_name()
    answers["no region name"] = region(roi_name="")
    answers["region name leaves the folder"] = region(roi_name="../region")
    answers["region name is the mesh's"] = region(roi_name="Bone.stl")
    answers["no output folder for the region"] = region(mesh_directory="")
    answers["output folder for the region is gone"] = region(mesh_directory=LONG_AGO)
    answers["thickness 0"] = region(cut_thickness=0.0)
    bpy.ops.mesh.primitive_cube_add()
    bpy.context.view_layer.objects.active = None
    camera = bpy.data.objects.new("camera", bpy.data.cameras.new("camera"))
    bpy.context.scene.collection.objects.link(camera)
    bpy.context.view_layer.objects.active = camera
    answers["a camera is active"] = region()
    bpy.context.view_layer.objects.active = bone
    bone.data.clear_geometry()
    answers["mesh without vertices"] = region()
    return answers


def without_selection() -> dict[str, str]:
    """What is said in Edit Mode, where nothing is selected."""
    ops = bpy.ops.bonemesh
    bpy.ops.object.mode_set(mode="EDIT")
    answers = {
        f"{case} in Edit Mode": stage.message_of(operator)
        for case, operator in {
            "no selection": ops.select_roi,
            "no selection to mirror": ops.mirror_roi,
            "no selection to measure": ops.measure_thickness,
            "no selection for a plane": ops.plane_from_vertices,
        }.items()
    }
    bpy.ops.object.mode_set(mode="OBJECT")
    return answers


def mirrored_without_name() -> str:
    """The error of a mirrored region without a name."""
    properties = bpy.context.scene.bonemesh
    properties.roi_name = ""
    message = stage.message_of(bpy.ops.bonemesh.mirror_roi)
    properties.roi_name = "region"
    return message


def main(zip: str, out: str, ct: str) -> dict[str, Any]:
    """Says all the messages, and what was written in spite of them."""
    folder = Path(out)
    stage.install(zip)
    meshes = folder / "meshes"
    meshes.mkdir()
    stage.fill_panel(ct, str(meshes))
    messages = pickers(folder) | renderings(folder)
    left = sorted(p.name for p in meshes.iterdir())
    messages |= regions(folder)
    messages["files after the refused renderings"] = ", ".join(left)
    messages["files after the refused regions"] = ", ".join(
        sorted(p.name for p in meshes.iterdir())
    )
    messages |= tools(folder)
    return {"messages": messages}


def tools(folder: Path) -> dict[str, str]:
    """What the other operators refuse, with a bone in the scene."""
    bpy.context.scene.bonemesh.mesh_name = "for the tools"
    bpy.ops.bonemesh.render_surface_mesh()
    return refusals_of_tools.main(folder, bpy.context.view_layer.objects.active)
