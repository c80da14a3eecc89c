"""How plans are looked at: the page, the plot, and what a notebook shows of them."""
