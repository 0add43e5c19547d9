"""The linear Mindlin plate."""
