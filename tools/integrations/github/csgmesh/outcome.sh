#!/bin/bash
# SPDX-License-Identifier: MIT
# The job's summary and its verdict: 2 what could not be done, 1 what is at fault or differs, 0 else.
set -u
work=${RUNNER_TEMP:-/tmp}
worst=0
for name in mesh diff; do
    status=$(cat "$work/csgmesh-$name-status" 2>/dev/null || echo 0)
    [ "$status" -le "$worst" ] || worst=$status
done
cat "$work/csgmesh-report.md" >>"${GITHUB_STEP_SUMMARY:-/dev/stdout}"
mesh=$(cat "$work/csgmesh-mesh-status" 2>/dev/null || echo 2)
outcome=same
[ "$worst" -eq 0 ] || outcome=different
{ [ "$mesh" -eq 0 ] && [ "$worst" -lt 2 ]; } || outcome=failed
echo "outcome=$outcome" >>"${GITHUB_OUTPUT:-/dev/stdout}"
exit "$worst"
