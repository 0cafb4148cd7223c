#!/bin/bash
# SPDX-License-Identifier: MIT
# Meshes $MANIFEST to $DIRECTORY. A failure is noted and told at the end, after the comparison.
set -u
work=${RUNNER_TEMP:-/tmp}
: >"$work/csgmesh-report.md"
# shellcheck disable=SC2086 # each option and each scene is one word
"$CSGMESH" batch $MANIFEST -d "$DIRECTORY" --junit "$work/csgmesh-batch.xml" $OPTIONS
status=$?
echo "$status" >"$work/csgmesh-mesh-status"
if [ $status -ne 0 ]; then
    echo "**Not all scenes could be meshed** (exit $status): see the log." >>"$work/csgmesh-report.md"
fi
exit 0
