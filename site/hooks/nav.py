"""Pages of the navigation that are not written yet are left out of it. A misspelt one does not slip through: its page is
then in no navigation, which --strict makes an error (validation.nav.omitted_files)."""
import pathlib


def on_config(config):
    config.nav = _existing(config.nav, pathlib.Path(config.docs_dir))
    return config


def _existing(entries, docs):
    kept = []
    for entry in entries:
        (title, target), = entry.items()
        if isinstance(target, list):
            target = _existing(target, docs)
        elif not (docs / target).exists():
            continue
        if target:
            kept.append({title: target})
    return kept
