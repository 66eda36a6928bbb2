# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright the Neural Mesh authors

"""The files from which MeshLab 2020.09 takes what it draws: project, view, settings."""

import os
from xml.sax.saxutils import quoteattr

# The attributes of one kind of primitive and the switches of a layer, in the order of MeshLab's
# project files (its classes GLMeshAttributesInfo and MLPerViewGLOptions).
ATTRIBUTES = ("position", "vertex normal", "face normal", "vertex color", "face color", "vertex texture",
              "wedge texture", "vertex index", "edge index")
SWITCHES = ("visible", "box info", "edge extra", "edge boundary", "face boundary", "edge manifold",
            "vertex manifold", "text boundary", "faux wire", "wire", "cull", "single side", "double side",
            "fancy", "selection", "vertex selection", "face selection", "box", "box fixed color",
            "points fixed color", "wire fixed color", "solid fixed color", "box mesh color",
            "points mesh color", "wire mesh color", "solid mesh color", "dots", "points unlit", "wire unlit",
            "solid unlit", "round points", "points shrink with distance")
# With the ambient light of OpenGL and MeshLab (0.2 + 0.125) it adds up to 1, so that a surface that faces the viewer
# has exactly the colours of the legend.
WHITE = (255, 255, 255)
LIGHT = (172, 172, 172)


def bits(names, chosen):
    """A string of one 0 or 1 per name."""
    return "".join("1" if name in chosen else "0" for name in names)


def layer_bits(style, color):
    """Which primitives a style draws, with which attributes and switches, as MeshLab's string of bits."""
    points = style == "points"
    wires = style in ("wireframe", "flat-lines", "smooth-lines")
    paint = {"vertex color"} if color else set()
    point_attributes = {"position"} | paint if points else set()
    # Corners are shared, hence indexed, unless each face brings its own normal.
    if points:
        solid_attributes = set()
    elif style.startswith("flat"):
        solid_attributes = {"position", "face normal"} | paint
    else:
        solid_attributes = {"position", "vertex normal", "vertex index"} | paint
    wire_attributes = {"position"} | (solid_attributes & {"vertex index"}) if wires else set()
    switches = {"visible", "single side", "box fixed color", "wire fixed color", "points unlit", "wire unlit"}
    if not color:
        switches |= {"points fixed color", "solid fixed color"}
    if wires:
        switches.add("wire")
    if style == "wireframe" and not color:
        switches.add("solid unlit")
    # The first four: solid, triangles' wires, edges' wires, points.
    return (f"{int(not points)}{int(wires)}0{int(points)}" + bits(ATTRIBUTES, point_attributes)
            + bits(ATTRIBUTES, ()) + bits(ATTRIBUTES, wire_attributes) + bits(ATTRIBUTES, solid_attributes)
            + bits(SWITCHES, switches))


def rendering_option(picture, supersampling):
    """The project file's element with a layer's rendering options."""
    hides_lines = picture.style == "wireframe" and not picture.color

    def rgba(rgb):
        return "{} {} {} 255".format(*rgb)

    surface = WHITE if hides_lines else picture.surface_color
    return (f'<RenderingOption pointSize="{picture.point_size * supersampling:g}" '
            f'wireWidth="{picture.line_width * supersampling:g}" boxColor="{rgba(WHITE)}" '
            f'pointColor="{rgba(picture.line_color)}" wireColor="{rgba(picture.line_color)}" '
            f'solidColor="{rgba(surface)}">{layer_bits(picture.style, picture.color)}</RenderingOption>')


def project_text(pictures, matrices, supersampling):
    """A MeshLab project with one layer per picture, moved by its 4 x 4 matrix."""
    layers = []
    for index, (picture, matrix) in enumerate(zip(pictures, matrices)):
        rows = "\n".join(" ".join(f"{value:.9g}" for value in row) + " " for row in matrix)
        layers.append(f'<MLMesh label="layer{index}" filename={quoteattr(os.path.abspath(picture.mesh))} '
                      f'visible="1">\n<MLMatrix44>\n{rows}\n</MLMatrix44>\n'
                      f"{rendering_option(picture, supersampling)}\n</MLMesh>")
    return "<!DOCTYPE MeshLabDocument>\n<MeshLabProject>\n<MeshGroup>\n" + "\n".join(layers) + \
        "\n</MeshGroup>\n<RasterGroup/>\n</MeshLabProject>\n"


# The camera of all layers: orthographic, on the z axis, looking along it.
VIEW_TEXT = """<!DOCTYPE ViewState>
<project>
<VCGCamera TranslationVector="0 0 -40.0816 1" LensDistortion="0 0" ViewportPx="1000 1000"
 PixelSizeMm="0.036916077 0.036916077" CenterPx="500 500" FocalMm="422.75" CameraType="1" BinaryData="0"
 RotationMatrix="1 0 0 0 0 1 0 0 0 0 1 0 0 0 0 1 "/>
<ViewSettings TrackScale="1" NearPlane="0.4008" FarPlane="50"/>
</project>
"""
# Half the height of the camera's view, in its units.
HALF_HEIGHT = 1.75


def color_setting(name, rgb):
    """One colour of MeshLab's settings, as Qt's settings file stores it."""
    return (f'MeshLab%3A%3AAppearance%3A%3A{name}="<!DOCTYPE MeshLabSettings>\\n<Param a=\\"255\\" '
            f'name=\\"MeshLab::Appearance::{name}\\" description=\\"\\" type=\\"RichColor\\" tooltip=\\"\\" '
            f'r=\\"{rgb[0]}\\" g=\\"{rgb[1]}\\" b=\\"{rgb[2]}\\"/>\\n"\n')


def settings_text():
    """MeshLab's settings: a plain background, a neutral light, no check for newer versions."""
    return ("[General]\n" + color_setting("backgroundBotColor", WHITE)
            + color_setting("backgroundTopColor", WHITE) + color_setting("baseLightDiffuseColor", LIGHT)
            + "dontRemindMeAboutUpgrade=true\ndontRemindMeToSendEmail=true\n"
            + "lastTimeMeshLabVersionCheckedOnStart=Tue Jan 1 2999\n")
