#!/bin/bash
# SPDX-License-Identifier: MIT
# One comment on the pull request, found again by a marker of its own, whoever wrote what after it: written when meshes
# differ, kept up to date by later runs, and told when all is well again. None where all was well from the start.
set -u
work=${RUNNER_TEMP:-/tmp}
marker="<!-- csgmesh meshes ${MARKER:-} -->"
failed=$(cat "$work/csgmesh-mesh-status" "$work/csgmesh-diff-status" 2>/dev/null | grep -vx 0 || true)
comments="repos/${GITHUB_REPOSITORY:-}/issues"
body=$work/csgmesh-comment.md

give_up() {
    echo "::warning::csgmesh: the comment could not be written (pull-requests: write?)"
    exit 0
}

# The first that begins with the marker; its number, or nothing.
known=$(gh api --paginate "$comments/$PULL_REQUEST/comments?per_page=100" \
    --jq ".[] | select(.body | startswith(\"$marker\")) | .id") || give_up
known=${known%%$'\n'*}
[ -n "$failed" ] || [ -n "$known" ] || exit 0
{
    echo "$marker"
    [ -n "$failed" ] || echo "**All meshes are well again.**"
    cat "$work/csgmesh-report.md"
} >"$body"
if [ -n "$known" ]; then
    gh api --method PATCH "$comments/comments/$known" -F "body=@$body" --silent || give_up
else
    gh api --method POST "$comments/$PULL_REQUEST/comments" -F "body=@$body" --silent || give_up
fi
