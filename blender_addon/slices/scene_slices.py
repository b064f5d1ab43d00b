# SPDX-License-Identifier: GPL-3.0-or-later
"""CT slices in the scene; with scene/meshes.py and its sisters the only writer of Blender's data.

Slices are empties that show an image: these are seen in every kind of shading, exactly as grey as the
CT is (nothing lights them), and need no mesh, material or setting of the view. Under them lies the
stack: an empty whose axes are the stack's to the left, the back and the head, hung on the bone, so that
slices stay with a bone that is moved. In it one number of a slice's location is its position in mm.
"""

from __future__ import annotations

from typing import Any

import bpy
import numpy as np
from mathutils import Matrix

from ..scene.meshes import link
from ..views.patient import world_from_patient
from .pictures import picture_file
from .slice_store import AXES, PLANES, Shown

STACK = "CT Slices"
KIND = "bonemesh_slice"  # on each of the objects: "stack", a plane's name, or that with " contour"
# Neither a grey of the images nor a colour of bones, regions and what is selected.
CONTOUR_COLOUR = (0.15, 1.0, 0.1, 1.0)
CONTOUR_MATERIAL = "Bonemesh Contour"
CONTOUR_RADIUS_PX = 0.5  # of the volume's finest pixel: thin enough to judge an edge by


def found(kind: str) -> Any:
    """The object of that kind, if there is one."""
    return next((o for o in bpy.data.objects if o.get(KIND) == kind), None)


def position_mm(name: str) -> float | None:
    """Where a slice is along its normal."""
    placed = found(name)
    return None if placed is None else placed.location[AXES[name]]


def move(name: str, to_mm: float) -> None:
    """Puts a slice elsewhere along its normal."""
    placed = found(name)
    if placed is not None:
        placed.location[AXES[name]] = to_mm


def show(context: Any, shown: Shown, surface: Any) -> None:
    """Adds the slices, or takes those that are there, for `shown`; hangs them on `surface` if there is one."""
    stack = found("stack") or new_empty(context, STACK, "stack")
    stack.empty_display_size = 1.0
    hang(stack, surface)
    hide_lines_to_parents()
    stack.matrix_basis = Matrix(shown.patient_from_stack.tolist()).to_4x4()
    for name in PLANES:
        show_plane(context, shown, stack, name)
    context.view_layer.update()


def hang(stack: Any, surface: Any) -> None:
    """Makes the patient's frame the parent: that of the bone as it lies in the scene, or else the world."""
    if surface is None:
        stack.parent = None
        stack.matrix_parent_inverse = Matrix.Identity(4)
        return
    stack.parent = surface
    to_patient = world_from_patient(surface)
    stack.matrix_parent_inverse = surface.matrix_world.inverted_safe() @ to_patient


def hide_lines_to_parents() -> None:
    """Takes the dashed lines from slices to their stack, across the images, out of every 3D view."""
    for screen in bpy.data.screens:
        for area in screen.areas:
            for space in area.spaces:
                if space.type == "VIEW_3D":
                    space.overlay.show_relationship_lines = False


def show_plane(context: Any, shown: Shown, stack: Any, name: str) -> None:
    """One slice with its contour; where it was before, or in the middle."""
    plane = shown.planes[name]
    placed = found(name)
    low, high = plane.positions_mm
    position = shown.middle_mm(name)
    if placed is None:
        placed = new_empty(context, f"{name.capitalize()} Slice", name)
    elif low <= placed.location[AXES[name]] <= high:
        position = placed.location[AXES[name]]
    placed.empty_display_type = "IMAGE"
    placed.empty_display_size = max(plane.shape) * plane.pixel_mm
    placed.empty_image_side = "DOUBLE_SIDED"
    placed.parent = stack
    placed.matrix_parent_inverse = Matrix.Identity(4)
    placed.matrix_basis = Matrix(shown.stack_from_plane(name, position).tolist())
    lock(placed, AXES[name])
    limit(placed, AXES[name], low, high)
    contour = found(f"{name} contour") or new_contour(context, name)
    contour.parent = stack
    contour.matrix_parent_inverse = Matrix.Identity(4)
    contour.data.bevel_depth = CONTOUR_RADIUS_PX * min(
        p.pixel_mm for p in shown.planes.values()
    )


def lock(placed: Any, axis: int) -> None:
    """Lets a slice be moved along its normal alone."""
    placed.lock_location = [a != axis for a in range(3)]
    placed.lock_rotation = (True, True, True)
    placed.lock_rotation_w = True
    placed.lock_scale = (True, True, True)


def limit(placed: Any, axis: int, low: float, high: float) -> None:
    """Keeps a slice within the volume, also while it is moved by hand."""
    kept = placed.constraints.get("Within the Volume")
    if kept is None:
        kept = placed.constraints.new("LIMIT_LOCATION")
        kept.name = "Within the Volume"
    kept.owner_space = "LOCAL"
    kept.use_transform_limit = True
    letter = "xyz"[axis]
    for end, value in (("min", low), ("max", high)):
        setattr(kept, f"use_{end}_{letter}", True)
        setattr(kept, f"{end}_{letter}", value)


def draw_picture(name: str, grey: np.ndarray) -> None:
    """Shows `grey` (rows, columns), 0 to 255, the top row first, as the slice's image."""
    placed = found(name)
    if placed is None:
        return
    image = kept_image(name)
    if image is None or tuple(image.size) != grey.shape[::-1]:
        image = new_image(name, grey.shape)
    placed.data = image
    file = picture_file(grey)
    # Packed, not painted: a painted image counts as unsaved work, of which Blender would warn on quitting.
    image.pack(data=file, data_len=len(file))
    image.source = "FILE"
    image.buffers_free()


def kept_image(name: str) -> Any:
    """The image of a slice, shown or taken off."""
    return next((i for i in bpy.data.images if i.get(KIND) == name), None)


def new_image(name: str, shape: tuple[int, ...]) -> Any:
    """An image for a slice; what was there before goes."""
    before = kept_image(name)
    if before is not None:
        bpy.data.images.remove(before)
    image = bpy.data.images.new(f"CT {name.capitalize()}", shape[1], shape[0])
    image[KIND] = name
    return image


def draw_contour(name: str, lines: list[np.ndarray]) -> None:
    """Shows lines (N, 3), in the stack's frame, as the slice's contour."""
    contour = found(f"{name} contour")
    if contour is None:
        return
    curve = contour.data
    curve.splines.clear()
    for line in lines:
        is_closed = len(line) > 2 and np.array_equal(line[0], line[-1])
        points = line[:-1] if is_closed else line
        spline = curve.splines.new("POLY")
        spline.points.add(len(points) - 1)
        places = np.ones((len(points), 4), dtype=np.float32)
        places[:, :3] = points
        spline.points.foreach_set("co", places.ravel())
        spline.use_cyclic_u = is_closed


def is_shown(name: str) -> bool:
    """Whether a slice is seen."""
    placed = found(name)
    return placed is not None and not placed.hide_viewport


def set_shown(name: str, is_seen: bool) -> None:
    """Shows or hides a slice with its contour."""
    for kind in (name, f"{name} contour"):
        placed = found(kind)
        if placed is not None:
            placed.hide_viewport = not is_seen


def remove() -> None:
    """Takes slices, contours and their images away."""
    for placed in [o for o in bpy.data.objects if KIND in o]:
        data = placed.data
        bpy.data.objects.remove(placed)
        if isinstance(data, bpy.types.Curve):
            bpy.data.curves.remove(data)
    for image in [i for i in bpy.data.images if KIND in i]:
        bpy.data.images.remove(image)


def take_pictures_off() -> None:
    """Lets the slices go without their images, which are then no part of a file that is saved."""
    for name in PLANES:
        placed = found(name)
        if placed is not None:
            placed.data = None


def new_empty(context: Any, label: str, kind: str) -> Any:
    """An empty of that kind, linked."""
    placed = bpy.data.objects.new(label, None)
    placed[KIND] = kind
    link(context, placed, context.scene.collection)
    return placed


def new_contour(context: Any, name: str) -> Any:
    """A curve without lines, as thick as a hair; not to be picked in place of its slice."""
    curve = bpy.data.curves.new(f"{name.capitalize()} Contour", "CURVE")
    curve.dimensions = "3D"
    curve.bevel_resolution = 0
    curve.materials.append(contour_material())
    placed = bpy.data.objects.new(curve.name, curve)
    placed[KIND] = f"{name} contour"
    placed.hide_select = True
    link(context, placed, context.scene.collection)
    return placed


def contour_material() -> Any:
    """Bright by itself, so that it shows in every light."""
    material = bpy.data.materials.get(CONTOUR_MATERIAL)
    if material is None:
        material = bpy.data.materials.new(CONTOUR_MATERIAL)
        material.diffuse_color = CONTOUR_COLOUR
        material.use_nodes = True
        shader = material.node_tree.nodes.get("Principled BSDF")
        if shader is not None:
            shader.inputs["Base Color"].default_value = CONTOUR_COLOUR
            shader.inputs["Emission Color"].default_value = CONTOUR_COLOUR
            shader.inputs["Emission Strength"].default_value = 1.0
    return material
