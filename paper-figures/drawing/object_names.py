"""Names of objects as figures print them, with a star where the mesh is a stand-in."""

# Objects that are common things, of which the paper's own mesh is unknown. The others are meshes of
# that very name that the literature shares.
STAND_INS = {
    "bowling": "BOWLING (a pin)",
    "toy_car": "TOY CAR (low-poly)",
    "cage": "CAGE (a cube frame)",
    "torus": "TORUS",
    "ball": "BALL (a scanned softball)",
    "bottle": "BOTTLE",
    "flower_pot": "FLOWER POT",
    "mug": "MUG",
    "buddha_head": "BUDDHA HEAD",
    "shark": "SHARK",
    "duck": "DUCK",
}
# Objects of the gallery (Fig. 12) by hand, in the paper's order.
GALLERY = {
    "gripper": ("kitten", "bunny", "bimba", "dinosaur", "pegaso"),
    "Barrett": ("duck", "squirrel", "teddy", "horse", "armadillo"),
    "human": ("toy_car", "bottle", "shark", "mug", "buddha_head"),
}
NOTE = "* not known to be the paper's own mesh: another object of that name"


def shown_name(name):
    """BUNNY for bunny; names of stand-ins have a star."""
    known = STAND_INS.get(name)
    return f"{known}*" if known else name.replace("_", " ").upper()


def short_name(name):
    """MUG* for mug: without what kind of stand-in it is."""
    return name.replace("_", " ").upper() + ("*" if name in STAND_INS else "")


def has_stand_in(names):
    return any(name in STAND_INS for name in names)


def note_for(names, more=None):
    """The note that belongs under a figure of these objects; None where there is none."""
    parts = ([NOTE] if has_stand_in(names) else []) + ([more] if more else [])
    return "\n".join(parts) or None
