# SPDX-License-Identifier: MIT
"""The bill of materials of a build: which libraries csgmesh was built with, as CycloneDX 1.5.

    sbom.py OUTPUT VERSION COMPILERS LIBRARY...

meson.build calls it when a folder is configured. COMPILERS is text; a LIBRARY is NAME|VERSION|PURPOSE|PKGCONFIG, as
meson found it. What pkg-config says that these need in turn is listed too, with the edges between them, and on Debian the package
that each comes from. The same build has the same bytes: the serial number is made from what is listed, and there is a time
only where SOURCE_DATE_EPOCH says one. Not listed: the libraries of C and C++ themselves, and what only tests use.
"""
import datetime
import json
import os
import shutil
import subprocess
import sys
import urllib.parse
import uuid

PKG_CONFIG = os.environ.get("PKG_CONFIG", "pkg-config")


def said(*command):
    """What a command prints; nothing where it is not there."""
    if not shutil.which(command[0]):
        return ""
    done = subprocess.run(command, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True, check=False)
    return done.stdout.strip()


def needed_by(name):
    """The names that a library's file for pkg-config requires, itself or for static linking; versions are left out."""
    lines = said(PKG_CONFIG, "--print-requires", "--print-requires-private", name).splitlines()
    return sorted({line.split()[0] for line in lines if line.strip()} - {name})


def debian_packages(references):
    """Package URLs, by reference, of what holds the libraries' files for pkg-config, where dpkg knows it."""
    files = {}
    for reference in references:
        folder = said(PKG_CONFIG, "--variable=pcfiledir", reference)
        if folder:
            files[os.path.join(folder, reference + ".pc")] = reference
    packages = {}
    for line in said("dpkg-query", "-S", *sorted(files)).splitlines() if files else []:
        owner, file = line.split(": ", 1)
        if file in files:
            packages[owner] = packages.get(owner, []) + [files[file]]
    form = "${binary:Package} ${Package} ${Version} ${Architecture} ${source:Package}\n"
    urls = {}
    for line in said("dpkg-query", "-W", "-f", form, *sorted(packages)).splitlines() if packages else []:
        owner, package, version, architecture, source = line.split(" ")
        for reference in packages.get(owner, packages.get(f"{package}:{architecture}", [])):
            urls[reference] = (f"pkg:deb/debian/{package}@{urllib.parse.quote(version, safe='')}"
                               f"?arch={architecture}&upstream={source}")
    return urls


def component(reference, name, version, purpose):
    made = {"type": "library", "bom-ref": reference, "name": name, "version": version}
    if purpose:
        made["description"] = purpose
    return made


def bill(version, compilers, rows):
    """The whole document, without what depends on when it is made."""
    components, edges, left = {}, {}, []
    for row in rows:
        name, number, purpose, reference = row.split("|")
        if reference in components:  # expat reads SVG and 3MF
            components[reference]["description"] += "; " + purpose
        else:
            components[reference] = component(reference, name, number, purpose)
        left.append(reference)
    edges["csgmesh"] = sorted(components)
    while left:
        reference = left.pop()
        if reference in edges:
            continue
        edges[reference] = needed_by(reference)
        for other in edges[reference]:
            components.setdefault(other, component(other, other, said(PKG_CONFIG, "--modversion", other), ""))
        left += edges[reference]
    for reference, url in debian_packages(components).items():
        components[reference]["purl"] = url
    return {
        "bomFormat": "CycloneDX", "specVersion": "1.5", "version": 1,
        "metadata": {
            "component": {"type": "application", "bom-ref": "csgmesh", "name": "csgmesh", "version": version,
                          "licenses": [{"license": {"id": "MIT"}}]},
            "properties": [{"name": "csgmesh:compilers", "value": compilers}]},
        "components": [components[key] for key in sorted(components)],
        "dependencies": [{"ref": key, "dependsOn": edges[key]} for key in sorted(edges)]}


def main():
    output, version, compilers, *rows = sys.argv[1:]
    document = bill(version, compilers, rows)
    document["serialNumber"] = f"urn:uuid:{uuid.uuid5(uuid.NAMESPACE_URL, json.dumps(document, sort_keys=True))}"
    epoch = os.environ.get("SOURCE_DATE_EPOCH", "")
    if epoch.isdigit():
        when = datetime.datetime.fromtimestamp(int(epoch), datetime.timezone.utc)
        document["metadata"]["timestamp"] = when.strftime("%Y-%m-%dT%H:%M:%SZ")
    with open(output, "w", encoding="utf-8") as file:
        json.dump(document, file, indent=1)
        file.write("\n")


if __name__ == "__main__":
    main()
