#!/usr/bin/env bash
# Makes the draft of a release on GitHub of all files in a folder, with their sums and the notes of CHANGELOG.md.
#   scripts/draft.sh v0.1.0 FOLDER          needs gh, and GH_TOKEN where nobody is logged in
#   scripts/draft.sh v0.1.0 FOLDER --dry    writes SHA256SUMS and prints the notes, and asks GitHub for nothing
set -euo pipefail
if [ $# -lt 2 ] || [ ! -d "$2" ]; then
    echo "usage: $0 TAG FOLDER [--dry]" >&2
    exit 2
fi
tag=$1
folder=$(cd "$2" && pwd)
cd "$(dirname "$0")/.."

python3 scripts/version.py --tag "$tag" >/dev/null
notes=$(mktemp)
trap 'rm -f "$notes"' EXIT
python3 scripts/version.py --notes >"$notes"

(
    cd "$folder"
    rm -f SHA256SUMS
    sha256sum -- * >"$notes.sums"
    mv "$notes.sums" SHA256SUMS
    cat SHA256SUMS
)

if [ "${3-}" = --dry ]; then
    cat "$notes"
    exit
fi
# A version as 0.2.0-rc.1 is one to try.
kind=()
[[ $tag != *-* ]] || kind=(--prerelease)
gh release create "$tag" --draft --verify-tag --title "Nabiki ${tag#v}" --notes-file "$notes" "${kind[@]}" "$folder"/*
