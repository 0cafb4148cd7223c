# SPDX-License-Identifier: MIT
# From a clone:
#     nix-build tools/packaging/nix
#     nix-env -if tools/packaging/nix
{ pkgs ? import <nixpkgs> { } }:

let
  root = ../../..;
  # meson.build owns the version.
  line = builtins.head (builtins.filter (l: builtins.match "  version: '.*'," l != null)
    (pkgs.lib.splitString "\n" (builtins.readFile (root + "/meson.build"))));
  version = builtins.head (builtins.match "  version: '(.*)'," line);
in
pkgs.stdenv.mkDerivation {
  pname = "csgmesh";
  inherit version;

  src = pkgs.lib.cleanSourceWith {
    src = root;
    filter = path: type:
      pkgs.lib.cleanSourceFilter path type
      && !(type == "directory" && builtins.match "build.*|node_modules" (baseNameOf path) != null);
  };

  nativeBuildInputs = with pkgs; [ meson ninja pkg-config python3 ];
  buildInputs = with pkgs; [
    clipper
    curl
    draco
    expat
    fontconfig
    freetype
    fribidi
    harfbuzz
    libb2
    libmicrohttpd
    libpng
    libzip
    meshoptimizer
    nlohmann_json
    qhull
    zlib
  ];

  mesonFlags = [ "-Dtests=disabled" "-Dwerror=false" ];
  mesonBuildType = "release";

  meta = {
    description = "Compiler from text scenes of solids and blends to watertight triangle meshes";
    license = pkgs.lib.licenses.mit;
    mainProgram = "csgmesh";
    platforms = pkgs.lib.platforms.linux;
  };
}
