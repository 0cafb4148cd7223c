#!/bin/bash
# SPDX-License-Identifier: MIT
# One comment on the pull request, kept up to date by its author's later runs; none when all is well.
set -u
work=${RUNNER_TEMP:-/tmp}
failed=$(cat "$work/csgmesh-mesh-status" "$work/csgmesh-diff-status" 2>/dev/null | grep -vx 0 || true)
[ -n "$failed" ] || exit 0
gh pr comment "$PULL_REQUEST" --body-file "$work/csgmesh-report.md" --edit-last 2>/dev/null ||
    gh pr comment "$PULL_REQUEST" --body-file "$work/csgmesh-report.md" ||
    echo "::warning::csgmesh: the comment could not be written (pull-requests: write?)"
