"""Live page: parameters, state, seas, server and static page."""
