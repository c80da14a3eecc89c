"""Views of plans: the page, the plot, and HTML for notebooks."""
