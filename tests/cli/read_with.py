# SPDX-License-Identifier: MIT
"""read_with.py READER FILE...: one line of JSON for each file, what the reader (a Python package) finds of test_readers.py's scene.

In a process of its own, for some of these packages cannot be loaded together. "refused" holds the message of a file that is not read.
"""
import json
import sys

GOLD, METALLIC, ROUGHNESS, TITLE = (218, 165, 32), 1.0, 0.3, "Three parts"


def is_gold(color, most):
    """Also as linear light, which some keep and some do not."""
    srgb = [c / 255 for c in GOLD]
    linear = [((c + 0.055) / 1.055) ** 2.4 for c in srgb]
    return any(all(abs(float(a) / most - b) < 0.02 for a, b in zip(color, wanted)) for wanted in (srgb, linear))


def with_trimesh(path):
    import trimesh  # pylint: disable=import-outside-toplevel,import-error
    scene = trimesh.load(path, split_object=True, group_material=False) if path.endswith("obj") else trimesh.load(path)
    shapes = getattr(scene, "geometry", {"": scene})
    looks = [getattr(shape.visual, "material", None) for shape in shapes.values()]
    colors = [shape.visual.vertex_colors for shape in shapes.values() if shape.visual.kind == "vertex"]
    mains = [look.main_color for look in looks if look is not None]
    return {"size": scene.extents.tolist(), "unit": scene.units, "names": list(shapes), "metadata": TITLE in str(scene.metadata),
            "normals": any("vertex_normals" in shape._cache.cache for shape in shapes.values()), # pylint: disable=protected-access
            "colours": any(is_gold(row, 255) for rows in colors for row in rows) or any(is_gold(main, 255) for main in mains),
            "materials": any(getattr(look, "metallicFactor", None) == METALLIC for look in looks),
            "shapes": len(shapes), "shown": len(scene.graph.nodes_geometry) if hasattr(scene, "graph") else 1}


def with_meshio(path):
    import meshio  # pylint: disable=import-outside-toplevel,import-error
    mesh = meshio.read(path)
    points, data = mesh.points[:, :3], mesh.point_data
    colors = zip(*(data[name] for name in ("red", "green", "blue"))) if "red" in data else [] # as signed bytes
    return {"size": (points.max(0) - points.min(0)).tolist(), "normals": "nx" in data or "obj:vn" in data,
            "colours": any(is_gold([int(c) % 256 for c in row], 255) for row in colors), "shapes": 1, "shown": 1}


def with_pymeshlab(path):
    import numpy  # pylint: disable=import-outside-toplevel,import-error
    import pymeshlab  # pylint: disable=import-outside-toplevel,import-error
    meshes = pymeshlab.MeshSet()
    meshes.load_new_mesh(path)
    shapes = list(meshes)
    points = numpy.vstack([shape.transformed_vertex_matrix() for shape in shapes])
    colors = [shape.vertex_color_matrix() for shape in shapes if shape.has_vertex_color()]
    colors += [shape.face_color_matrix() for shape in shapes if shape.has_face_color()]
    return {"size": (points.max(0) - points.min(0)).tolist(), "names": [shape.label() for shape in shapes], "shapes": 1, "shown": 1,
            "normals": None, "colours": any(is_gold(row, 1) for rows in colors for row in rows)}


def principled(material):
    return next(node for node in material.node_tree.nodes if node.type == "BSDF_PRINCIPLED").inputs


def with_bpy(path):
    import bpy  # pylint: disable=import-outside-toplevel,import-error
    bpy.ops.wm.read_factory_settings(use_empty=True)
    ways = {"stl": "wm.stl_import", "ply": "wm.ply_import", "obj": "wm.obj_import"}
    group, name = ways.get(path[-3:], "import_scene.gltf").split(".")
    getattr(getattr(bpy.ops, group), name)(filepath=path)
    objects = [o for o in bpy.data.objects if o.type == "MESH"]
    points = [o.matrix_world @ v.co for o in objects for v in o.data.vertices]
    materials = [principled(m) for m in bpy.data.materials if m.node_tree]
    painted = [a.data for o in objects for a in o.data.color_attributes]
    return {"size": [max(p[k] for p in points) - min(p[k] for p in points) for k in range(3)], "names": [o.name for o in objects],
            "normals": any(o.data.has_custom_normals for o in objects),
            "colours": any(is_gold(value.color, 1) for data in painted for value in data)
                       or any(is_gold(m["Base Color"].default_value, 1) for m in materials),
            "materials": any(m["Metallic"].default_value == METALLIC and abs(m["Roughness"].default_value - ROUGHNESS) < 1e-5
                             for m in materials),
            "metadata": TITLE in str([dict(scene) for scene in bpy.data.scenes]),
            "shapes": len({o.data.name for o in objects}), "shown": len(objects)}


def with_lib3mf(path):
    import lib3mf  # pylint: disable=import-outside-toplevel,import-error
    model = lib3mf.get_wrapper().CreateModel()
    reader = model.QueryReader(path[-3:])
    reader.SetStrictModeActive(True)
    reader.ReadFromFile(path)
    names, points, objects, groups = [], [], model.GetMeshObjects(), model.GetBaseMaterialGroups()
    while objects.MoveNext():
        item = objects.GetCurrentMeshObject()
        names.append(item.GetName())
        points += [list(vertex.Coordinates) for vertex in item.GetVertices()]
    colors, materials = [], []
    while groups.MoveNext():
        group = groups.GetCurrentBaseMaterialGroup()
        for i in group.GetAllPropertyIDs():
            color = group.GetDisplayColor(i)
            colors.append((color.Red, color.Green, color.Blue))
            materials.append(group.GetName(i))
    title = model.GetMetaDataGroup()
    return {"size": [max(p[k] for p in points) - min(p[k] for p in points) for k in range(3)], "names": names, "shapes": 1, "shown": 1,
            "warnings": reader.GetWarningCount(), "unit": str(model.GetUnit()), "normals": False, "colours": any(is_gold(c, 255) for c in colors),
            "materials": "goldenrod-metal100-rough30" in materials,
            "metadata": any(title.GetMetaData(i).GetValue() == TITLE for i in range(title.GetMetaDataCount()))}


def main(reader, paths):
    for path in paths:
        try:
            found = globals()["with_" + reader](path)
        except (Exception, SystemExit) as error:  # pylint: disable=broad-exception-caught
            found = {"refused": f"{type(error).__name__}: {error}"}
        print("FOUND" + json.dumps(found), flush=True)


if __name__ == "__main__":
    main(sys.argv[1], sys.argv[2:])
