# SPDX-License-Identifier: GPL-3.0-or-later
"""Names and a folder for meshes where the user gave none. Knows no bpy.

A series' description is typed by people and may hold anything, a patient's name too: only words that
name a part of the body, or what kind of image it is, get into a name.
"""

from __future__ import annotations

import os
import re
from collections.abc import Callable, Iterable
from itertools import count
from pathlib import Path

from .inputs import NOT_IN_NAMES

BONE = "bone"
MOST_WORDS = 4
WORD = re.compile(r"[^\W\d_]+")
# In the languages that scanners are most often set to; left out are those that are common as names.
PLAIN = """
    abdomen ankle arm articulation atlas body bone bones brain calcaneus cardiac carpal cervical chest clavicle
    coccyx cochlea cranial cranium dental elbow extremity face facial feet femoral femur fibula finger fingers foot
    forearm frontal hand head heel hip hips humerus iac inner ear jaw jaws joint knee knees larynx leg legs limb
    lower lumbar mandible mandibular mastoid maxilla maxillary maxillofacial metacarpal metatarsal middle midface
    nasal neck nose occipital orbit orbital orbits palate parietal patella pelvic pelvis petrous phantom radius rib
    ribs sacrum scaphoid scapula shoulder shoulders sinus sinuses skull spine sternum talus teeth temporal thigh
    thoracic thorax tibia tmj toe toes tooth trunk ulna upper vertebra vertebrae wrist zygoma left right
    schädel schaedel kopf gesicht kiefer oberkiefer unterkiefer zähne zaehne wirbelsäule hws bws lws becken
    hüfte huefte oberschenkel unterschenkel knie fuss sprunggelenk schulter ellenbogen handgelenk felsenbein
    crâne tête rachis bassin hanche genou cheville épaule coude poignet mâchoire dents
    cráneo cabeza cuello columna cadera rodilla tobillo hombro codo muñeca mandíbula
    cranio collo bacino anca ginocchio caviglia spalla gomito polso mandibola
"""
PLAIN_WORDS = frozenset(PLAIN.split())


def stem_of(description: str) -> str:
    """What a series shows, from its description: `head` of "HEAD 0.75 H60s"; `bone` where that says nothing."""
    words = (word.casefold() for word in WORD.findall(description))
    plain = dict.fromkeys(word for word in words if word in PLAIN_WORDS)
    return " ".join(tuple(plain)[:MOST_WORDS]) or BONE


def as_stem(name: str) -> str:
    """An object's name as that of a file."""
    return NOT_IN_NAMES.sub("-", name).strip(" .") or BONE


def free(stem: str, is_taken: Callable[[str], bool]) -> str:
    """`stem`, or with a number after it where it is taken."""
    names = (stem if number == 1 else f"{stem}-{number}" for number in count(1))
    return next(name for name in names if not is_taken(name))


def folder(candidates: Iterable[Path]) -> str:
    """The first of the folders that is there and can be written to; the top of a disk is none of them."""
    for candidate in candidates:
        is_top = candidate.parent == candidate
        if not is_top and candidate.is_dir() and os.access(candidate, os.W_OK):
            return str(candidate)
    return ""


def candidates(blend_file: str, ct_images: str, home: Path) -> list[Path]:
    """Where meshes may go: with the scene once that is saved, beside the images, among the documents."""
    near = [Path(file).parent for file in (blend_file, ct_images) if file.strip()]
    return [*near, home / "Documents", home] if near else []
