#!/bin/bash
# SPDX-License-Identifier: MIT
# Compares the folders $GOLDENS and $DIRECTORY by the names in them; the report goes to the job's
# summary, and to a file for the comment.
set -u
work=${RUNNER_TEMP:-/tmp}
"$CSGMESH" diff "$GOLDENS" "$DIRECTORY" --tol "$TOLERANCE" --json "$work/csgmesh-diff.json" \
    --html "$work/csgmesh-diff.html" >"$work/csgmesh-diff.txt"
status=$?
if [ -f "$work/csgmesh-diff.html" ]; then echo "report=$work/csgmesh-diff.html" >>"${GITHUB_OUTPUT:-/dev/null}"; fi
cat "$work/csgmesh-diff.txt"
echo "$status" >"$work/csgmesh-diff-status"
{
    case $status in
    0) echo "All meshes are within $TOLERANCE of \`$GOLDENS\`." ;;
    1) echo "**Meshes differ from \`$GOLDENS\`** (tolerance $TOLERANCE):" ;;
    *) echo "**The meshes could not be compared** (exit $status): see the log." ;;
    esac
    if [ $status -eq 1 ]; then
        python3 "$(dirname "$0")/table.py" "$work/csgmesh-diff.json" || sed 's/^/    /' "$work/csgmesh-diff.txt"
        echo
        echo "To accept: \`csgmesh diff $GOLDENS $DIRECTORY --update\`, and commit \`$GOLDENS\`."
    fi
} >>"$work/csgmesh-report.md"
exit 0
