# SPDX-License-Identifier: MIT
"""Meshes of scenes as targets of Bazel; see docs/batch.md.

    load("@rules_csgmesh//:csgmesh.bzl", "csgmesh_mesh")

    csgmesh_mesh(
        name = "mug",
        scene = "mug.txt",
        deps = ["lib/base.txt"],        # all that the scene includes, uses or imports
        formats = ["glb", "stl"],       # mug.glb, mug.stl
        resolution = 64,
        defines = {"radius": "3"},
    )

Which program it is says csgmesh_local (in WORKSPACE) or the extension of extensions.bzl (in MODULE.bazel).
"""

def _arguments(ctx, outputs, parameter_set):
    arguments = ctx.actions.args()
    arguments.add(ctx.file.scene)
    arguments.add_all(outputs, before_each = "-o")
    arguments.add("--no-sync")  # Bazel looks at the files at once; a power cut costs its cache, too
    arguments.add("--quiet")
    arguments.add("--threads=%d" % ctx.attr.threads)
    if ctx.attr.resolution:
        arguments.add("--resolution=%d" % ctx.attr.resolution)
    for name, value in ctx.attr.defines.items():
        arguments.add("--define=%s=%s" % (name, value))
    for folder in ctx.attr.includes:
        # of sources, and of what other rules have made
        for root in ["", ctx.bin_dir.path]:
            parts = [root, ctx.label.workspace_root, ctx.label.package, folder]
            arguments.add("--include=" + "/".join([part for part in parts if part]))
    if ctx.file.parameter_file:
        arguments.add(ctx.file.parameter_file, format = "--parameter-file=%s")
    if parameter_set:
        arguments.add("--parameter-set=" + parameter_set)
    arguments.add_all(ctx.attr.options)
    return arguments

def _make(ctx, parameter_set):
    stem = ctx.attr.out or ctx.label.name
    if parameter_set:
        stem += "-" + parameter_set
    outputs = [ctx.actions.declare_file(stem + "." + format) for format in ctx.attr.formats]
    inputs = [ctx.file.scene] + ctx.files.deps
    if ctx.file.parameter_file:
        inputs.append(ctx.file.parameter_file)
    ctx.actions.run(
        executable = ctx.executable.csgmesh,
        arguments = [_arguments(ctx, outputs, parameter_set)],
        inputs = inputs,
        outputs = outputs,
        mnemonic = "CsgmeshMesh",
        progress_message = "Meshing %s%s" % (
            ctx.file.scene.short_path,
            " (%s)" % parameter_set if parameter_set else "",
        ),
    )
    return outputs

def _csgmesh_mesh_impl(ctx):
    if not ctx.attr.formats:
        fail("formats: a mesh has one format at least")
    if ctx.attr.sets and not ctx.file.parameter_file:
        fail("sets: they are of a parameter_file, which is missing")
    if ctx.file.parameter_file and not ctx.attr.sets:
        fail("parameter_file: name its sets")
    outputs = []
    for parameter_set in ctx.attr.sets or [""]:
        outputs += _make(ctx, parameter_set)
    return [DefaultInfo(files = depset(outputs), runfiles = ctx.runfiles(files = outputs))]

csgmesh_mesh = rule(
    implementation = _csgmesh_mesh_impl,
    doc = "One scene, meshed once for each set of parameters and written in each format.",
    attrs = {
        "scene": attr.label(
            mandatory = True,
            allow_single_file = True,
            doc = "The scene.",
        ),
        "deps": attr.label_list(
            allow_files = True,
            doc = "Files that the scene includes, uses or imports (csgmesh deps lists them).",
        ),
        "formats": attr.string_list(
            default = ["glb"],
            doc = "Extensions of the outputs: glb, stl, ply ..., of flat scenes svg, dxf or pdf.",
        ),
        "out": attr.string(
            doc = "The outputs' name without extension (the target's).",
        ),
        "resolution": attr.int(
            doc = "As csgmesh mesh -r; 0: cells follow the shape.",
        ),
        "defines": attr.string_dict(
            doc = "Values for the scene's parameters, as expressions of its language: \"3\", '\"text\"'.",
        ),
        "parameter_file": attr.label(
            allow_single_file = True,
            doc = "Sets of parameters, a JSON file.",
        ),
        "sets": attr.string_list(
            doc = "Names of sets; each has outputs of its own, mug-small.glb.",
        ),
        "includes": attr.string_list(
            doc = "Folders in which the scene looks for files, below this package.",
        ),
        "options": attr.string_list(
            doc = "More options of csgmesh mesh.",
        ),
        "threads": attr.int(
            default = 1,
            doc = "Bazel runs many meshes at once; the bytes are the same for any number.",
        ),
        "csgmesh": attr.label(
            default = Label("@csgmesh//:csgmesh"),
            executable = True,
            allow_single_file = True,
            cfg = "exec",
            doc = "The program.",
        ),
    },
)

def _csgmesh_local_impl(repository):
    found = repository.attr.path or repository.os.environ.get("CSGMESH")
    path = repository.path(found) if found else repository.which("csgmesh")
    if not path or not path.exists:
        fail("there is no csgmesh in PATH: name it by csgmesh_local(path = ...) or $CSGMESH")

    # A copy, so that another program makes other meshes.
    result = repository.execute(["cp", str(path), "csgmesh"])
    if result.return_code:
        fail("cannot copy %s: %s" % (path, result.stderr))
    repository.file("BUILD.bazel", """exports_files(["csgmesh"], visibility = ["//visibility:public"])\n""")

csgmesh_local = repository_rule(
    implementation = _csgmesh_local_impl,
    doc = "The csgmesh of this machine: at `path`, at $CSGMESH or in PATH. `bazel sync --configure` or " +
          "`bazel fetch --force` takes a newer one.",
    attrs = {"path": attr.string(doc = "Its absolute path.")},
    environ = ["CSGMESH", "PATH"],
    local = True,
    configure = True,
)
